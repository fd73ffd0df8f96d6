"""The scripts for other programs, without those programs: stand-ins with the attributes the scripts use.

    python3 tools_test.py TOOLS_FOLDER PELLUCID_COMMAND
"""
import importlib
import json
import os
import subprocess
import sys
import tempfile
import types
import unittest

sys.dont_write_bytecode = True
TOOLS, COMMAND = sys.argv[1:3]
sys.path.insert(0, TOOLS)
IDENTITY = [[float(i == j) for j in range(4)] for i in range(4)]


def stand_in(**attributes):
    return types.SimpleNamespace(**attributes)


class RenderDoc(unittest.TestCase):
    def setUp(self):
        self.script = importlib.import_module("renderdoc_capture")
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def info(self, manifest):
        path = os.path.join(self.folder.name, "manifest.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(manifest, file)
        run = subprocess.run([COMMAND, "info", path], capture_output=True, text=True, check=False)
        return run.returncode, run.stderr

    def test_info_names_what_is_missing(self):
        files = {name: name + ".exr" for name in self.script.TEXTURES}
        manifest = self.script.manifest_skeleton(files)
        steps = [("camera.clipFromView", lambda: manifest["camera"].update(clipFromView=sum(IDENTITY, []))),
                 ("camera.viewFromWorld", lambda: manifest["camera"].update(viewFromWorld=sum(IDENTITY, []))),
                 ("lights[0].direction", lambda: manifest["lights"][0].update(direction=[0, -1, 0])),
                 ("lights[0].intensity", lambda: manifest["lights"][0].update(intensity=1)),
                 ("lights[0].shadowMap.clipFromWorld",
                  lambda: manifest["lights"][0]["shadowMap"].update(clipFromWorld=sum(IDENTITY, [])))]
        for field, fill in steps:
            code, error = self.info(manifest)
            self.assertEqual(code, 3)
            self.assertIn(field, error)
            fill()
        self.assertIn("frontDepth.exr", self.info(manifest)[1])  # the manifest is whole, the pixels are not there
        del manifest["buffers"]["irradiance"]
        self.assertIn("buffers.irradiance: missing", self.info(manifest)[1])

    def test_unknown_buffers_are_refused(self):
        for name in ("depth", "shadowMap", "shadowMapX"):
            with self.assertRaisesRegex(ValueError, name):
                self.script.manifest_skeleton({name: "a.exr"})

    def test_textures_are_found_by_name(self):
        saved = {}

        def save(options, path):
            saved[os.path.basename(path)] = (options.resourceId, options.destType)
            with open(path, "w", encoding="utf-8"):
                pass

        def texture(number, width):
            return stand_in(resourceId=f"ResourceId::{number}", width=width, height=9, format=stand_in(Name=lambda: "D32"))

        controller = stand_in(
            GetResources=lambda: [stand_in(name=name, resourceId=f"ResourceId::{number}")
                                  for name, number in (("Z", 5), ("E", 6), ("Z", 8), ("Buffer", 9))],
            GetTextures=lambda: [texture(5, 4), texture(6, 16), texture(8, 16)], SaveTexture=save)
        rd = stand_in(TextureSave=lambda: stand_in(slice=stand_in()), FileType=stand_in(EXR="exr"),
                      AlphaMapping=stand_in(Preserve=0))
        files = self.script.save_textures(rd, controller, {"frontDepth": "Z", "irradiance": "E"},
                                          self.folder.name)
        self.assertEqual(files, {"frontDepth": "frontDepth.exr", "irradiance": "irradiance.exr"})
        self.assertEqual(saved, {"frontDepth.exr": ("ResourceId::8", "exr"), "irradiance.exr": ("ResourceId::6", "exr")})
        self.script.save_textures(rd, controller, {"frontDepth": 5, "irradiance": "ResourceId::6"}, self.folder.name)
        self.assertEqual(saved["frontDepth.exr"][0], "ResourceId::5")
        with self.assertRaisesRegex(ValueError, "(?s)Nothing, Buffer; there are.*5: Z, 4 x 9, D32.*6: E, 16 x 9, D32"):
            self.script.save_textures(rd, controller, {"normal": "Nothing", "albedo": "Buffer"}, self.folder.name)

    def test_a_shell_without_a_capture_says_so(self):
        with self.assertRaisesRegex(RuntimeError, "no capture is loaded: .*--ui-python"):
            self.script.capture_in_shell(None, stand_in(IsCaptureLoaded=lambda: False))


class Blender(unittest.TestCase):
    def test_record_is_complete(self):
        script = importlib.import_module("blender_export")

        def thing(**attributes):
            made = stand_in(hide_render=False, matrix_world=IDENTITY, **attributes)
            made.evaluated_get = lambda depsgraph: made
            return made

        spot = stand_in(type="SPOT", color=(1, 1, 1), energy=5.0, spot_size=0.8, spot_blend=0.1)
        area = stand_in(type="AREA", color=(1, 1, 1), energy=5.0)
        camera = thing(type="CAMERA", name="Camera",
                       calc_matrix_camera=lambda depsgraph, x, y, scale_x, scale_y: IDENTITY)
        class Material(dict):
            pass_index = 3

        scene = stand_in(
            camera=camera, unit_settings=stand_in(scale_length=0.001), frame_start=1, frame_end=2,
            frame_set=lambda frame: None,
            objects=[camera, thing(type="LIGHT", name="Key", data=spot), thing(type="LIGHT", name="Box", data=area)],
            render=stand_in(resolution_x=16, resolution_y=9, pixel_aspect_x=1, pixel_aspect_y=1))
        bpy = stand_in(data=stand_in(materials=[Material(pellucid="marble")]),
                       context=stand_in(scene=scene, evaluated_depsgraph_get=lambda: None,
                                        view_layer=stand_in(name="ViewLayer")))
        record = script.scene_record(bpy)
        self.assertEqual([light["name"] for light in record["lights"]], ["Key"])
        self.assertEqual(record["materials"], [{"passIndex": 3, "material": {"preset": "marble"}}])
        self.assertEqual(record["lights"][0]["spotSize"], 0.8)
        self.assertEqual(json.loads(json.dumps(record))["camera"]["projection"], IDENTITY)
        with tempfile.TemporaryDirectory() as folder:
            script.export(bpy, os.path.join(folder, "r.###.json"))
            script.export(bpy, os.path.join(folder, "still.json"))
            self.assertEqual(sorted(os.listdir(folder)), ["r.001.json", "r.002.json", "still.json"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
