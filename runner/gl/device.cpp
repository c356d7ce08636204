#include "runner/gl/device.h"
