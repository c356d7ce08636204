#pragma once

#include <tbb/by_threads.h>
