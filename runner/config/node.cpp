#include "runner/config/node.h"
