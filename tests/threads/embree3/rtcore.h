#pragma once

#include_next <embree3/rtcore.h>

#include <embree_by_one_thread.h>
