#include "runner/metrics/image_error.h"
