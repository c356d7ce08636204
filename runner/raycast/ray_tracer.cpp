#include "runner/raycast/ray_tracer.h"
