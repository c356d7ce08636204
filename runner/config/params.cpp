#include "runner/config/params.h"
