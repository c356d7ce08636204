#include "runner/gpu_scene/gpu_mesh.h"
