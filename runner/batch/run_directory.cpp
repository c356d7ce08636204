#include "runner/batch/plan.h"
