#include "runner/gl/program.h"
