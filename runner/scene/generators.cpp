#include "runner/scene/generators.h"
