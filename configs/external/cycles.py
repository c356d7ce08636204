"""blender -b --factory-startup -noaudio --python-exit-code 1 -P cycles.py -- SCENE.glb SAMPLES SEED PATTERN WIDTH HEIGHT PICTURE.exr

Cycles draws a scene as gfxrepro exports it, seen by its first camera and lit by what shines, and says how long that took.
"""
import json
import os
import sys
import time

import bpy
import numpy

# The sampling patterns of Blender to 3.4, and from 3.5 on; from 4.2 on none is computed.
PATTERNS = {"computed": ("SOBOL", "SOBOL_BURLEY"), "tabulated": ("PROGRESSIVE_MULTI_JITTER", "TABULATED_SOBOL")}
numpy.bool = bool  # which Blender 3.4's importer still asks of NumPy
path, samples, seed, pattern, width, height, picture = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=path)
scene = bpy.context.scene
scene.camera = next(thing for thing in bpy.data.objects if thing.type == "CAMERA")
scene.render.engine = "CYCLES"
scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
scene.render.filepath = picture
scene.view_settings.view_transform = "Raw"
known = scene.cycles.bl_rna.properties["sampling_pattern"].enum_items.keys()
if not set(PATTERNS[pattern]) & set(known):
    raise RuntimeError(f"no sampling pattern of this Blender is {pattern}; it has {', '.join(known)}")
scene.cycles.sampling_pattern = next(name for name in PATTERNS[pattern] if name in known)
scene.cycles.samples, scene.cycles.seed = int(samples), int(seed)
scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
begin = time.perf_counter()
bpy.ops.render.render(write_still=True)
with open(os.environ["GFXREPRO_METRICS_FILE"], "w", encoding="utf-8") as file:
    print(json.dumps({"metric": "render_ms", "value": 1000 * (time.perf_counter() - begin), "unit": "ms"}), file=file)
