"""mirrors_test.py PROGRAM: both ray tracers of the reflections against Blender's path tracer Cycles, which shares no code with them.

The rooms as they are exported, but every mesh glows in one colour of its own, and what reflected is a perfect mirror: a pixel of a mirror shows
which mesh its ray meets. Pixels count that Cycles shows alike a hundredth of a pixel beside, where the mirror ray leaves on the seen side of its
triangle (Cycles bends the normals of others) and meets something. Exit 77: skipped, without Blender or NumPy.
"""
import json
import os
import struct
import subprocess
import sys
import tempfile

ROOMS = {"indoor/living_room": ["overview", "vase"], "indoor/bathroom": ["overview"]}
REAL_ROOM = {"indoor/real_living_room": ["camera"]}  # of GFXREPRO_ASSETS; its mirrors see the windows
SIZE = 320, 240
CONFIG = """sweep_of: witness
title: Mirrors
technique: clustered_reflections
output: {{width: {0}, height: {1}}}
measure: {{lane: quality}}
params: {{method: ray_traced, supersampling: 1, pictures: true, texture_filter: finest_level}}
scene: {2}
sweep: {{view: [{3}]}}
"""
MOST_DIFFERING = 0.0005  # of the pixels that count
SMOOTH = 0.4             # `reflector_roughness`


def read_glb(path):
    with open(path, "rb") as file:
        data = file.read()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + length]), data[28 + length:]


def write_glb(path, head, body):
    text = json.dumps(head).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(body)))
        file.write(struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(body), 0x004E4942) + body)


def glowing(head):
    """A material for each mesh: black but for a colour that is its own; a mirror where it reflected and has normals. What is clear goes."""
    old = head.get("materials", [])
    clear = [m.get("extensions", {}).get("KHR_materials_transmission", {}).get("transmissionFactor", 0) > 0.5 for m in old]
    for node in head["nodes"]:
        if "mesh" in node and clear[head["meshes"][node["mesh"]]["primitives"][0].get("material", -1)]:
            del node["mesh"]
    head["materials"] = []
    for index, mesh in enumerate(head["meshes"]):
        primitive = mesh["primitives"][0]
        pbr = old[primitive["material"]].get("pbrMetallicRoughness", {}) if "material" in primitive else {}
        is_mirror = pbr.get("roughnessFactor", 1) <= SMOOTH and "NORMAL" in primitive["attributes"]
        number = 97 * index % 343  # seven steps a channel
        color = [0.1 + 0.15 * (number // 7 ** i % 7) for i in range(3)]
        head["materials"].append({
            "name": f"m{index}", "doubleSided": True, "emissiveFactor": color,
            "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": int(is_mirror), "roughnessFactor": int(not is_mirror)}})
        primitive["material"] = index


def main(program):
    from witness import blender_or_skip, found_in  # not in Blender, whose path lacks this folder

    blender = blender_or_skip()
    counted = 0
    for room, views in (ROOMS | (REAL_ROOM if os.environ.get("GFXREPRO_ASSETS") else {})).items():
        with tempfile.TemporaryDirectory() as folder:
            model = os.path.join(folder, "room.glb")
            subprocess.run([program, "scene", room, "--export", model], check=True, stdout=subprocess.DEVNULL)
            head, body = read_glb(model)
            glowing(head)
            write_glb(model, head, body)
            config = os.path.join(folder, "witness.yaml")
            with open(config, "w", encoding="utf-8") as file:
                file.write(CONFIG.format(*SIZE, model, ", ".join(views)))
            run = os.path.join(folder, "run")
            subprocess.run([program, "run", config, "--device", "software", "--quiet", "--out", run], check=True)
            found = found_in(blender, __file__, folder, *views)
        for each in found:
            print(f"{room}, {each['view']}, {each['picture']}: {each['counted']} pixels of mirrors, {each['differing']} differ; "
                  f"{each['below']} leave below their triangle, of which {each['through']} show more than its own colour, {each['lost']} meet nothing, of which {each['lost_differing']} differ")
            counted += each["counted"]
            assert each["differing"] <= MOST_DIFFERING * each["counted"], each
            assert each["through"] <= max(1, 0.05 * each["below"]) and each["lost_differing"] <= 0.01 * each["lost"], each
    assert counted > 30000


def in_blender(folder, views):
    import csv

    import bpy
    import numpy as np
    from mathutils import Matrix

    BACKGROUND = 0.18, 0.20, 0.24  # kBackground
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.view_settings.view_transform = "Raw"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = 1, False, 1
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "GAUSSIAN", 0.01
    scene.world = bpy.data.worlds.new("background")
    scene.world.use_nodes = True
    sky = scene.world.node_tree.nodes["Background"].inputs[0]
    head, body = read_glb(os.path.join(folder, "room.glb"))

    def values_of(accessor, kind):
        about = head["accessors"][accessor]
        view = head["bufferViews"][about["bufferView"]]
        width = {"SCALAR": 1, "VEC3": 3}[about["type"]]
        return np.frombuffer(body, kind, about["count"] * width, view.get("byteOffset", 0) + about.get("byteOffset", 0)).reshape(-1, width)

    def matrix_of(node):
        return np.array(node.get("matrix", np.eye(4).ravel())).reshape(4, 4).T

    class Shader:
        """What is seen: colours and mirrors (0), the interpolated normal (1), the triangle's (2), the way to the eye (3)."""
        what = []

        def __init__(self, about):
            self.material = bpy.data.materials.new(about["name"])
            self.material.use_nodes = True
            self.tree = self.material.node_tree
            self.tree.nodes.clear()
            is_mirror = about["pbrMetallicRoughness"]["metallicFactor"] == 1
            geometry = self.node("ShaderNodeNewGeometry")
            attribute = self.node("ShaderNodeAttribute", attribute_name="smooth")
            normal = self.join("ShaderNodeVectorMath", attribute.outputs["Vector"], operation="NORMALIZE").outputs[0]
            # Turned where both the triangle's normal and the eye are on its other side, as shading.glsl has it.
            facing = self.join("ShaderNodeMath", *(self.join("ShaderNodeVectorMath", normal, geometry.outputs[way], operation="DOT_PRODUCT").outputs["Value"]
                                                   for way in ("True Normal", "Incoming")), operation="MAXIMUM").outputs[0]
            sign = self.join("ShaderNodeMath", self.join("ShaderNodeMath", facing, 1e-12, operation="ADD").outputs[0], operation="SIGN").outputs[0]
            seen = self.node("ShaderNodeVectorMath", operation="SCALE")
            self.tree.links.new(normal, seen.inputs[0])
            self.tree.links.new(sign, seen.inputs["Scale"])
            color = self.node("ShaderNodeRGB")
            color.outputs[0].default_value = *about["emissiveFactor"], 1
            self.mirror = self.node("ShaderNodeBsdfGlossy")
            self.mirror.inputs["Roughness"].default_value = 0
            self.tree.links.new(seen.outputs[0], self.mirror.inputs["Normal"])
            eye = self.node("ShaderNodeLightPath").outputs["Is Camera Ray"]
            self.reflects, self.is_mirror = self.join("ShaderNodeMath", eye, 0.0, operation="MULTIPLY"), float(is_mirror)
            shown = self.mixed(self.reflects.outputs[0], self.glow(color.outputs[0]), self.mirror.outputs[0])
            for value in (seen.outputs[0], geometry.outputs["True Normal"], geometry.outputs["Incoming"]):
                # Emission is not negative.
                half = self.node("ShaderNodeVectorMath", operation="MULTIPLY_ADD")
                self.tree.links.new(value, half.inputs[0])
                half.inputs[1].default_value = half.inputs[2].default_value = 0.5, 0.5, 0.5
                switch = self.node("ShaderNodeValue")
                Shader.what.append(switch)
                shown = self.mixed(switch.outputs[0], shown, self.glow(half.outputs[0]))
            self.tree.links.new(shown, self.node("ShaderNodeOutputMaterial").inputs[0])

        def node(self, kind, **settings):
            node = self.tree.nodes.new(kind)
            for key, value in settings.items():
                setattr(node, key, value)
            return node

        def join(self, kind, *inputs, **settings):
            node = self.node(kind, **settings)
            for at, value in enumerate(inputs):
                if isinstance(value, float):
                    node.inputs[at].default_value = value
                else:
                    self.tree.links.new(value, node.inputs[at])
            return node

        def glow(self, color):
            return self.join("ShaderNodeEmission", color).outputs[0]

        def mixed(self, share, first, second):
            return self.join("ShaderNodeMixShader", share, first, second).outputs[0]

    shaders = [Shader(about) for about in head["materials"]]
    for node in head["nodes"]:
        if "mesh" not in node:
            continue
        primitive = head["meshes"][node["mesh"]]["primitives"][0]
        place = matrix_of(node)
        position = values_of(primitive["attributes"]["POSITION"], np.float32).astype(np.float64) @ place[:3, :3].T + place[:3, 3]
        triangles = values_of(primitive["indices"], np.uint32).reshape(-1, 3)
        if "NORMAL" in primitive["attributes"]:
            normal = values_of(primitive["attributes"]["NORMAL"], np.float32).astype(np.float64) @ np.linalg.inv(place[:3, :3])
        else:
            normal = np.ones_like(position)
        mesh = bpy.data.meshes.new("mesh")
        mesh.vertices.add(len(position))
        mesh.vertices.foreach_set("co", position.astype(np.float32).ravel())
        mesh.loops.add(triangles.size)
        mesh.loops.foreach_set("vertex_index", triangles.astype(np.int32).ravel())
        mesh.polygons.add(len(triangles))
        mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
        mesh.polygons.foreach_set("loop_total", np.full(len(triangles), 3, np.int32))
        mesh.attributes.new("smooth", "FLOAT_VECTOR", "POINT").data.foreach_set("vector", normal.astype(np.float32).ravel())
        mesh.materials.append(shaders[primitive["material"]].material)
        mesh.update(calc_edges=True)
        scene.collection.objects.link(bpy.data.objects.new("mesh", mesh))

    def pixels(path):
        image = bpy.data.images.load(path, check_existing=False)
        image.colorspace_settings.name = "Non-Color"
        values = np.empty(SIZE[0] * SIZE[1] * 4, np.float32)
        image.pixels.foreach_get(values)
        bpy.data.images.remove(image)
        return values.reshape(-1, 4)[:, :3].astype(np.float64)

    def rendered(what=0, beside=0.0, background=BACKGROUND, reflected=1.0, reflects=True):
        for shader in shaders:
            shader.reflects.inputs[1].default_value = shader.is_mirror if reflects else 0
            shader.mirror.inputs["Color"].default_value = reflected, reflected, reflected, 1
        for at, switch in enumerate(Shader.what):
            switch.outputs[0].default_value = at % 3 + 1 == what
        scene.camera.data.shift_x = scene.camera.data.shift_y = beside / SIZE[1]
        sky.default_value = *background, 1
        scene.render.filepath = os.path.join(folder, "cycles.exr")
        bpy.ops.render.render(write_still=True)
        return pixels(scene.render.filepath)

    def differs(first, second):
        return np.abs(first - second).max(1) > 0.01  # colours are 0.15 apart

    with open(os.path.join(folder, "run", "images", "index.csv"), newline="", encoding="utf-8") as file:
        pictures = list(csv.DictReader(file))
    found = []
    for view in views:
        node = next(node for node in head["nodes"] if "camera" in node and node.get("name") == view)
        lens = head["cameras"][node["camera"]]["perspective"]
        camera = bpy.data.cameras.new(view)
        camera.sensor_fit, camera.angle_y, camera.clip_start, camera.clip_end = "VERTICAL", lens["yfov"], lens["znear"], lens["zfar"]
        scene.camera = bpy.data.objects.new(view, camera)
        scene.collection.objects.link(scene.camera)
        scene.camera.matrix_world = Matrix(matrix_of(node).tolist())
        theirs = rendered()
        own = rendered(reflects=False)
        is_mirror = ~differs(rendered(reflected=0.0), np.zeros_like(theirs))
        is_firm = is_mirror & ~differs(theirs, rendered(beside=0.01))
        is_lost = differs(theirs, rendered(background=(1, 0, 1)))
        normal, across, to_eye = (2 * rendered(what) - 1 for what in (1, 2, 3))
        mirrored = 2 * (normal * to_eye).sum(1, keepdims=True) * normal - to_eye
        is_below = (mirrored * across).sum(1) <= 0
        for picture in ("result", "truth"):
            path = next(row["png"] for row in pictures if row["name"] == picture and f"view={view}" in row["png"])
            encoded = pixels(os.path.join(folder, "run", path))
            ours = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
            is_other = differs(theirs, ours)
            counts, is_gone = is_firm & ~is_below & ~is_lost, is_firm & ~is_below & is_lost
            found.append({
                "view": view, "picture": picture, "counted": int(counts.sum()), "differing": int((counts & is_other).sum()),
                "below": int((is_firm & is_below).sum()), "through": int((is_firm & is_below & differs(own, ours)).sum()), "lost": int(is_gone.sum()), "lost_differing": int((is_gone & is_other).sum())})
    with open(os.path.join(folder, "found.json"), "w", encoding="utf-8") as file:
        json.dump(found, file)


if "--" in sys.argv:
    in_blender(sys.argv[sys.argv.index("--") + 1], sys.argv[sys.argv.index("--") + 2:])
else:
    main(sys.argv[1])
