#include "techniques/clustered_reflections/clustering.h"

#include "tests/gl/gl_fixture.h"
