#include "runner/scene/catalog.h"
