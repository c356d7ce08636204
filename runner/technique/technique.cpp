#include "runner/technique/technique.h"
