#include "runner/image/exr_io.h"
