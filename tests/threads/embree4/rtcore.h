#pragma once

#include_next <embree4/rtcore.h>

#include <embree_by_one_thread.h>
