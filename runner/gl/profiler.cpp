#include "runner/gl/profiler.h"
