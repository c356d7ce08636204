#include "runner/gl/objects.h"
