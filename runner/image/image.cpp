#include "runner/image/image.h"
