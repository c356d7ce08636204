#include "runner/config/experiment.h"
