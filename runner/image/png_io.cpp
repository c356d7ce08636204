#include "runner/image/png_io.h"
