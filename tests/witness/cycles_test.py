"""cycles_test.py PROGRAM: the shadow rays of soft_shadows against Blender's path tracer Cycles, which shares no code with them.

A city under eight point lights. A pixel agrees where both show it lit, or both in shadow. Exit 77: skipped, without Blender or NumPy.
"""
import json
import os
import subprocess
import sys
import tempfile

SCENE = "outdoor/city"
SIZE = 320, 240
AZIMUTHS_DEG = range(0, 360, 45)
ELEVATION_DEG, HEIGHT = 40, 1.5  # HEIGHT: distance from the centre of the box, in its diagonals
CONFIG = f"""sweep_of: witness
title: Shadow rays under eight point lights
technique: soft_shadows
scene: {SCENE}
output: {{width: {SIZE[0]}, height: {SIZE[1]}}}
measure: {{lane: quality}}
params: {{method: ray_traced, light_ratio: 0, light_grid: 1, light_elevation_deg: {ELEVATION_DEG}, light_height: {HEIGHT}, ground: false,
  errors: false, pictures: true}}
sweep: {{light_azimuth_deg: [{", ".join(map(str, AZIMUTHS_DEG))}]}}
"""
# Of the pixels that are lit in either. Rays that begin 1e-4 diagonals along the normal differ in 0.54 %.
MOST_DIFFERING = 0.002


def main(program):
    from witness import blender_or_skip, found_in  # not in Blender, whose path lacks this folder

    blender = blender_or_skip()
    with tempfile.TemporaryDirectory() as folder:
        config = os.path.join(folder, "witness.yaml")
        with open(config, "w", encoding="utf-8") as file:
            file.write(CONFIG)
        run = os.path.join(folder, "run")
        subprocess.run([program, "run", config, "--device", "software", "--quiet", "--out", run], check=True)
        subprocess.run([program, "scene", SCENE, "--export", os.path.join(folder, "scene.glb")], check=True, stdout=subprocess.DEVNULL)
        found = found_in(blender, __file__, folder)
    share = found["differing"] / found["lit"]
    print(f"{found['lit']} pixels lit, {found['differing']} differ ({100 * share:.3f} %), {found['moved']} of Cycles' own when its light moves")
    assert found["lit"] > 50000 and share < MOST_DIFFERING


def in_blender(folder):
    import csv

    import bpy
    import numpy as np
    from mathutils import Vector

    np.bool = bool  # which Blender's importer still asks of NumPy
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=os.path.join(folder, "scene.glb"))
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.view_settings.view_transform = "Raw"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = 1, False, 0
    # The middle of each pixel.
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "GAUSSIAN", 0.01
    scene.render.use_persistent_data = True
    scene.world = bpy.data.worlds.new("dark")
    scene.world.color = 0, 0, 0
    scene.camera = next(thing for thing in bpy.data.objects if thing.type == "CAMERA")
    white = bpy.data.materials.new("white")
    white.use_nodes = True
    glowing = bpy.data.materials.new("colour")  # what gfxrepro shows of a surface in full light
    glowing.use_nodes = True
    nodes = glowing.node_tree
    nodes.nodes.clear()
    color = nodes.nodes.new("ShaderNodeVertexColor")
    emission = nodes.nodes.new("ShaderNodeEmission")
    nodes.links.new(color.outputs[0], emission.inputs[0])
    nodes.links.new(emission.outputs[0], nodes.nodes.new("ShaderNodeOutputMaterial").inputs[0])
    corners = []
    meshes = [thing for thing in bpy.data.objects if thing.type == "MESH"]
    for thing in meshes:
        thing.cycles.shadow_terminator_geometry_offset = thing.cycles.shadow_terminator_offset = 0
        thing.data.polygons.foreach_set("use_smooth", [False] * len(thing.data.polygons))
        if thing.data.has_custom_normals:
            with bpy.context.temp_override(object=thing, active_object=thing):
                bpy.ops.mesh.customdata_custom_splitnormals_clear()
        corners += [thing.matrix_world @ vertex.co for vertex in thing.data.vertices]
    corners = np.array(corners)
    low, high = corners.min(0), corners.max(0)
    diagonal = float(np.linalg.norm(high - low))

    def rendered(material):
        for thing in meshes:
            thing.data.materials.clear()
            thing.data.materials.append(material)
        scene.render.filepath = os.path.join(folder, "cycles.exr")
        bpy.ops.render.render(write_still=True)
        return pixels(scene.render.filepath)

    def pixels(path):
        image = bpy.data.images.load(path, check_existing=False)
        image.colorspace_settings.name = "Non-Color"
        values = np.empty(SIZE[0] * SIZE[1] * 4, np.float32)
        image.pixels.foreach_get(values)
        bpy.data.images.remove(image)
        return values.reshape(-1, 4)[:, :3]

    full = rendered(glowing).max(1)
    lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT"))
    lamp.data.shadow_soft_size, lamp.data.energy, lamp.data.cycles.max_bounces = 0, 1e9, 0
    scene.collection.objects.link(lamp)

    def lit_by_cycles(azimuth_deg, moved=0.0):
        azimuth, elevation = np.radians(azimuth_deg), np.radians(ELEVATION_DEG)
        # gfxrepro's y is Blender's z.
        away = Vector((np.sin(azimuth) * np.cos(elevation), -np.cos(azimuth) * np.cos(elevation), np.sin(elevation)))
        lamp.location = Vector(0.5 * (low + high)) + HEIGHT * diagonal * away + moved * diagonal * Vector((1, 1, 1))
        return rendered(white).max(1) > 0

    with open(os.path.join(folder, "run", "images", "index.csv"), newline="", encoding="utf-8") as file:
        pictures = [row["png"] for row in csv.DictReader(file) if row["name"] == "shadow"]
    assert len(pictures) == len(AZIMUTHS_DEG), pictures
    found = {"lit": 0, "differing": 0, "moved": 0}
    for picture in pictures:
        azimuth = next(a for a in AZIMUTHS_DEG if f"light_azimuth_deg={a}-" in picture or f"light_azimuth_deg={a}," in picture)
        encoded = pixels(os.path.join(folder, "run", picture)).max(1)
        linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
        ours = (linear > 0.5 * full) & (full > 0)  # in shadow it is 0.15 of the colour
        theirs = lit_by_cycles(azimuth) & (full > 0)
        found["lit"] += int((ours | theirs).sum())
        found["differing"] += int((ours != theirs).sum())
        found["moved"] += int((theirs != (lit_by_cycles(azimuth, 1e-5) & (full > 0))).sum())
    with open(os.path.join(folder, "found.json"), "w", encoding="utf-8") as file:
        json.dump(found, file)


if "--" in sys.argv:
    in_blender(sys.argv[sys.argv.index("--") + 1])
else:
    main(sys.argv[1])
