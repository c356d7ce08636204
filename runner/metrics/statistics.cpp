#include "runner/metrics/statistics.h"
