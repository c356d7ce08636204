#include "runner/scene/load.h"
