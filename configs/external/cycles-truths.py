"""cycles-truths.py WHAT SCENE.glb VIEW WIDTH HEIGHT OUT: a ground truth of gfxrepro, held against Cycles, Blender's path tracer.

Makes the scene plain, has both draw it (gfxrepro and blender, as PATH has them), and counts the pixels that differ, of those that Cycles itself
shows alike a hundredth of a pixel beside. Leaves OUT/gfxrepro.pfm and OUT/cycles.pfm, where pixels that do not count are black.
"""
import json
import os
import struct
import subprocess
import sys

SMOOTH = 0.4  # `reflector_roughness`: what is as smooth reflects
GRID = 4      # light samples along an edge of a soft light
TRACED = f"method: ray_traced, light_grid: {GRID}, ground: false, errors: false"
# Technique, picture, parameters; of shadows azimuth, elevation, distance of the light and diagonal of its square, both in diagonals of the scene.
TRUTHS = {
    "mirrors": ("clustered_reflections", "truth", "method: ray_traced, supersampling: 1, texture_filter: finest_level", None),
    "soft shadows": ("soft_shadows", "shadow", TRACED + ", light_ratio: 1", (35, 60, 1.5, 1)),
    "narrow soft shadows": ("soft_shadows", "shadow", TRACED + ", light_ratio: 0.25", (35, 60, 1.5, 0.25)),
    "hard shadows of a lamp": ("shadow_mapping", "truth_0", "errors: true, light_kind: spot", (-40, 50, 1.2, 0)),
    "hard shadows of the sun": ("shadow_mapping", "truth_0", "errors: true, light_kind: directional", (-40, 50, 1.2, 0)),
}
BACKGROUND = 0.18, 0.20, 0.24  # what gfxrepro shows where a mirror's ray meets nothing


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


def make_plain(head, shows_mirrors):
    """A material for each mesh: white for shadows; for mirrors it glows in a colour of its own, and mirrors where it reflected. What is clear goes."""
    old = head.get("materials", [])
    head["materials"] = []
    for index, mesh in enumerate(head["meshes"]):
        primitive = mesh["primitives"][0]
        about = old[primitive["material"]] if "material" in primitive else {}
        if shows_mirrors and about.get("extensions", {}).get("KHR_materials_transmission", {}).get("transmissionFactor", 0) > 0.5:
            for node in head["nodes"]:
                if node.get("mesh") == index:
                    del node["mesh"]
        primitive["attributes"].pop("COLOR_0", None)
        primitive["material"] = index
        reflects = about.get("pbrMetallicRoughness", {}).get("roughnessFactor", 1) <= SMOOTH and "NORMAL" in primitive["attributes"]
        number = 97 * index % 343  # seven steps a channel
        head["materials"].append({"name": f"m{index}", "doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0}} if not shows_mirrors else {
            "name": f"m{index}", "doubleSided": True, "emissiveFactor": [0.1 + 0.15 * (number // 7 ** i % 7) for i in range(3)],
            "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": int(reflects), "roughnessFactor": int(not reflects)}})


def main(what, scene, view, width, height, out):
    technique, _, params, light = TRUTHS[what]
    head, body = read_glb(scene)
    make_plain(head, light is None)
    write_glb(os.path.join(out, "plain.glb"), head, body)
    config = os.path.join(out, "truth.yaml")
    with open(config, "w", encoding="utf-8") as file:
        file.write(f"sweep_of: truth\ntitle: Truth\ntechnique: {technique}\nscene: plain.glb\noutput: {{width: {width}, height: {height}}}\n"
                   f"measure: {{lane: quality}}\nparams: {{pictures: true, view: '{view}', {params}}}\n")
    ended = subprocess.run(["gfxrepro", "run", config, "--device", "software", "--quiet", "--out", os.path.join(out, "run")])
    if ended.returncode != 0:
        sys.exit(ended.returncode)
    # Debian's Blender takes the first Python of PATH, which must be the system's.
    os.environ["PATH"] = "/usr/bin:" + os.environ["PATH"]
    os.execvp("blender", ["blender", "-b", "--factory-startup", "-noaudio", "--python-exit-code", "1", "-P", os.path.abspath(__file__), "--",
                          what, view, width, height, out])


def in_blender(what, view, width, height, out):
    import csv

    import bpy
    import numpy as np
    from mathutils import Matrix

    _, picture, _, light = TRUTHS[what]
    width, height = int(width), int(height)
    head, body = read_glb(os.path.join(out, "plain.glb"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.film_transparent = True
    scene.view_settings.view_transform = "Raw"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = 1, False, int(light is None)
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "GAUSSIAN", 0.01  # the middle of each pixel
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = *(BACKGROUND if light is None else (0, 0, 0)), 1

    def matrix_of(node):
        return np.array(node.get("matrix", np.eye(4).ravel())).reshape(4, 4).T

    def values_of(accessor, kind):
        about = head["accessors"][accessor]
        buffer = head["bufferViews"][about["bufferView"]]
        columns = {"SCALAR": 1, "VEC3": 3}[about["type"]]
        return np.frombuffer(body, kind, about["count"] * columns, buffer.get("byteOffset", 0) + about.get("byteOffset", 0)).reshape(-1, columns)

    def add_meshes(materials):
        """Each mesh where it stands; a corner of their box, and the opposite one."""
        corners = []
        for node in head["nodes"]:
            if "mesh" not in node:
                continue
            primitive = head["meshes"][node["mesh"]]["primitives"][0]
            place = matrix_of(node)
            position = values_of(primitive["attributes"]["POSITION"], np.float32).astype(np.float64) @ place[:3, :3].T + place[:3, 3]
            mesh = bpy.data.meshes.new("mesh")
            mesh.from_pydata(position.tolist(), [], values_of(primitive["indices"], np.uint32).reshape(-1, 3).tolist())
            if "NORMAL" in primitive["attributes"]:
                normal = values_of(primitive["attributes"]["NORMAL"], np.float32).astype(np.float64) @ np.linalg.inv(place[:3, :3])
                mesh.attributes.new("smooth", "FLOAT_VECTOR", "POINT").data.foreach_set("vector", normal.astype(np.float32).ravel())
            mesh.materials.append(materials[primitive["material"]])
            scene.collection.objects.link(bpy.data.objects.new("mesh", mesh))
            corners += [position.min(0), position.max(0)]
        return np.min(corners, 0), np.max(corners, 0)

    def add_camera():
        node = next(node for node in head["nodes"] if "camera" in node and view in ("", node.get("name")))
        lens = head["cameras"][node["camera"]]["perspective"]
        camera = bpy.data.cameras.new("eye")
        camera.sensor_fit, camera.angle_y, camera.clip_start, camera.clip_end = "VERTICAL", lens["yfov"], lens["znear"], lens["zfar"]
        scene.camera = bpy.data.objects.new("eye", camera)
        scene.collection.objects.link(scene.camera)
        scene.camera.matrix_world = Matrix(matrix_of(node).tolist())

    def pixels(path):
        image = bpy.data.images.load(path, check_existing=False)
        image.colorspace_settings.name = "Non-Color"
        values = np.empty(width * height * 4, np.float32)
        image.pixels.foreach_get(values)
        bpy.data.images.remove(image)
        return values.reshape(-1, 4).astype(np.float64)

    def rendered(beside=0.0):
        scene.camera.data.shift_x = scene.camera.data.shift_y = beside / height
        scene.render.filepath = os.path.join(out, "cycles.exr")
        bpy.ops.render.render(write_still=True)
        return pixels(scene.render.filepath)

    def shown():
        """gfxrepro's picture, linear; rows from the bottom up, as Blender has them."""
        with open(os.path.join(out, "run", "images", "index.csv"), newline="", encoding="utf-8") as file:
            path = next(row["png"] for row in csv.DictReader(file) if row["name"] == picture)
        encoded = pixels(os.path.join(out, "run", path))[:, :3]
        return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)

    def shadows():
        """What share of the light each pixel sees: by gfxrepro, by Cycles, and by Cycles a little beside; and the step of such shares."""
        azimuth_deg, elevation_deg, distance, ratio = light
        white = bpy.data.materials.new("white")
        white.use_nodes = True
        low, high = add_meshes([white] * len(head["materials"]))
        add_camera()
        scene.render.use_persistent_data = True  # the lamp alone moves
        azimuth, elevation, diagonal = np.radians(azimuth_deg), np.radians(elevation_deg), np.linalg.norm(high - low)
        to_light = np.array((np.sin(azimuth) * np.cos(elevation), np.sin(elevation), np.cos(azimuth) * np.cos(elevation)))
        right = np.array((np.cos(azimuth), 0, -np.sin(azimuth)))
        lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "SUN" if "sun" in what else "POINT"))
        setattr(lamp.data, "angle" if "sun" in what else "shadow_soft_size", 0)
        lamp.data.energy, lamp.data.cycles.max_bounces = 10 if "sun" in what else 1e9, 0
        scene.collection.objects.link(lamp)
        frame = np.eye(4)
        frame[:3, 0], frame[:3, 1], frame[:3, 2] = right, np.cross(to_light, right), to_light
        places = [(2 * i + 1) / GRID - 1 for i in range(GRID)] if ratio else [0]
        step = 1 / len(places) ** 2
        share = {0.0: 0, 0.01: 0}
        for x in places:
            for y in places:
                across = np.array((x, y, 0)) * ratio * diagonal / np.sqrt(8)
                frame[:3, 3] = 0.5 * (low + high) + distance * diagonal * to_light + frame[:3, :3] @ across
                lamp.matrix_world = Matrix(frame.tolist())
                for beside in share:
                    seen = rendered(beside)
                    share[beside] = share[beside] + step * (seen[:, :3].max(1) > 0)
        # In shadow it is 0.15 of the colour, and in the light all of it (hard shadows: 0.85).
        ours = np.clip((shown()[:, 0] - 0.15) / (0.85 if ratio else 0.7), 0, 1)
        return ours * (seen[:, 3] > 0.5), *share.values(), step

    class Mirror:
        """A material. Seen is the surface (0), its interpolated normal (1), the triangle's (2) or the way to the eye (3)."""

        def __init__(self, about):
            self.material = bpy.data.materials.new(about["name"])
            self.material.use_nodes = True
            self.tree = self.material.node_tree
            self.tree.nodes.clear()
            geometry = self.node("ShaderNodeNewGeometry").outputs
            normal = self.vector("NORMALIZE", self.node("ShaderNodeAttribute", attribute_name="smooth").outputs["Vector"])
            # Turned where both the triangle's normal and the eye are on its other side.
            sides = [self.vector("DOT_PRODUCT", normal, geometry[way], result="Value") for way in ("True Normal", "Incoming")]
            sign = self.number("SIGN", self.number("ADD", self.number("MAXIMUM", *sides), 1e-12))
            normal = self.vector("MULTIPLY", normal, sign)
            color = self.node("ShaderNodeRGB").outputs[0]
            color.default_value = *about["emissiveFactor"], 1
            self.mirror = self.node("ShaderNodeBsdfAnisotropic")  # Blender 4 has no other mirror
            self.mirror.inputs["Roughness"].default_value = self.mirror.inputs["Anisotropy"].default_value = 0
            self.tree.links.new(normal, self.mirror.inputs["Normal"])
            self.is_mirror = float(about["pbrMetallicRoughness"]["metallicFactor"])
            self.reflects = self.node("ShaderNodeValue").outputs[0]
            eye = self.node("ShaderNodeLightPath").outputs["Is Camera Ray"]
            shown = self.mixed(self.number("MULTIPLY", eye, self.reflects), self.glow(color), self.mirror.outputs[0])
            self.switches = []
            for value in (normal, geometry["True Normal"], geometry["Incoming"]):
                half = self.vector("ADD", self.vector("SCALE", value, Scale=0.5), (0.5, 0.5, 0.5))  # no light is negative
                self.switches.append(self.node("ShaderNodeValue").outputs[0])
                shown = self.mixed(self.switches[-1], shown, self.glow(half))
            self.tree.links.new(shown, self.node("ShaderNodeOutputMaterial").inputs[0])

        def node(self, kind, *inputs, **settings):
            node = self.tree.nodes.new(kind)
            for key, value in settings.items():
                setattr(node, key, value)
            for at, value in enumerate(inputs):
                if isinstance(value, (float, tuple)):
                    node.inputs[at].default_value = value
                else:
                    self.tree.links.new(value, node.inputs[at])
            return node

        def vector(self, operation, *inputs, result="Vector", **scalars):
            node = self.node("ShaderNodeVectorMath", *inputs, operation=operation)
            for name, value in scalars.items():
                node.inputs[name].default_value = value
            return node.outputs[result]

        def number(self, operation, *inputs):
            return self.node("ShaderNodeMath", *inputs, operation=operation).outputs[0]

        def glow(self, color):
            return self.node("ShaderNodeEmission", color).outputs[0]

        def mixed(self, share, first, second):
            return self.node("ShaderNodeMixShader", share, first, second).outputs[0]

        def set(self, seen, color, reflects):
            self.reflects.default_value = self.is_mirror * reflects
            self.mirror.inputs["Color"].default_value = color, color, color, 1
            for at, switch in enumerate(self.switches, 1):
                switch.default_value = at == seen

    def mirrors():
        """What each pixel of a mirror shows: by gfxrepro, by Cycles, and by Cycles a little beside. Others are black."""
        materials = [Mirror(about) for about in head["materials"]]
        add_meshes([each.material for each in materials])
        add_camera()

        def seen(what=0, beside=0.0, color=1.0, reflects=True):
            for each in materials:
                each.set(what, color, reflects)
            return rendered(beside)

        normal, across, to_eye = (2 * seen(what)[:, :3] - 1 for what in (1, 2, 3))
        mirrored = 2 * (normal * to_eye).sum(1, keepdims=True) * normal - to_eye
        black = seen(color=0.0)
        is_mirror = (black[:, 3] > 0.5) & (black[:, :3].max(1) < 0.05)
        # A ray below the surface mirrors nothing: its own colour shows. Cycles bends the normals of such.
        is_below = (mirrored * across).sum(1) <= 0
        own = seen(reflects=False)
        pictures = [np.where(is_below[:, None], own, seen(beside=beside))[:, :3] for beside in (0.0, 0.01)]
        return *(np.where(is_mirror[:, None], each, 0) for each in (shown(), *pictures)), 0.02  # colours are 0.15 apart

    ours, theirs, beside, step = shadows() if light else mirrors()
    ours, theirs, beside = (each.reshape(width * height, -1) for each in (ours, theirs, beside))

    def differs(first, second):
        return np.abs(first - second).max(1) > 0.5 * step

    counts = differs(ours, 0) | differs(theirs, 0)
    is_firm = counts & ~differs(theirs, beside)
    differing = is_firm & differs(ours, theirs)
    for name, values in (("gfxrepro", ours), ("cycles", theirs)):
        with open(os.path.join(out, name + ".pfm"), "wb") as file:
            file.write(f"PF\n{width} {height}\n-1.0\n".encode())
            file.write((values * is_firm[:, None] * np.ones(3)).astype("<f4").tobytes())
    with open(os.environ["GFXREPRO_METRICS_FILE"], "w", encoding="utf-8") as file:
        for metric, value, unit in (("counted", int(is_firm.sum()), "pixel"), ("differing_pct", 100 * float(differing.sum() / is_firm.sum()), "%"),
                                    ("beside_pct", 100 * float(1 - is_firm.sum() / counts.sum()), "%")):
            print(json.dumps({"metric": metric, "value": value, "unit": unit}), file=file)


if "--" in sys.argv:
    in_blender(*sys.argv[sys.argv.index("--") + 1:])
else:
    main(*sys.argv[1:])
