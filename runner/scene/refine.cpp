#include "runner/scene/scene.h"
