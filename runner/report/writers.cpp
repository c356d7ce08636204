#include "runner/report/records.h"
