"""The scripts for other programs, without those programs: stand-ins with the attributes the scripts use.

    python3 tools_test.py TOOLS_FOLDER PELLUCID_COMMAND
"""
import importlib
import json
import math
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


# Bliss 1952, The Statistics of Bioassay: lengths of guinea pigs' teeth by supplement (orange juice, ascorbic acid) and dose; R has
# them as ToothGrowth.
TEETH = [[[15.2, 21.5, 17.6, 9.7, 14.5, 10.0, 8.2, 9.4, 16.5, 9.7], [19.7, 23.3, 23.6, 26.4, 20.0, 25.2, 25.8, 21.2, 14.5, 27.3],
          [25.5, 26.4, 22.4, 24.5, 24.8, 30.9, 26.4, 27.3, 29.4, 23.0]],
         [[4.2, 11.5, 7.3, 5.8, 6.4, 10.0, 11.2, 11.2, 5.2, 7.0], [16.5, 16.5, 15.2, 17.3, 22.5, 17.3, 13.6, 14.5, 18.8, 15.5],
          [23.6, 18.5, 33.9, 25.5, 26.4, 32.5, 26.7, 21.5, 23.3, 29.5]]]


class Thesis(unittest.TestCase):
    def setUp(self):
        try:
            import numpy
            import scipy  # noqa: F401
        except ImportError as error:
            self.skipTest(f"{error}; ./run thesis installs it")
        self.script, self.numpy = importlib.import_module("thesis"), numpy

    def test_anova_is_r_s(self):
        # summary(aov(len ~ supp * factor(dose), ToothGrowth)), as R's documentation and textbooks print it.
        teeth = self.numpy.array(TEETH)
        table = self.script.two_way_anova(teeth)
        for source, squares, f in (("first", 205.35, 15.572), ("second", 2426.4, 92.0), ("interaction", 108.3, 4.107)):
            self.assertAlmostEqual(table[source][0], squares, delta=.05)
            self.assertAlmostEqual(table[source][2], f, delta=.0005)
        self.assertAlmostEqual(table["first"][3], .000231, delta=5e-7)
        self.assertAlmostEqual(table["interaction"][3], .02186, delta=5e-6)
        self.assertAlmostEqual(table["residual"][0], 712.1, delta=.05)
        self.assertEqual(table["residual"][1], 54)
        # (13.23 - 7.98) / sqrt(2 * 712.106 / 54 / 10); then (22.70 - 16.77) and (26.06 - 26.14).
        comparisons = list(self.script.compare_levels(teeth, table))
        for (_, t, _), expected in zip(comparisons, (3.2327, 3.6514, .0493)):
            self.assertAlmostEqual(t, expected, delta=1e-3)
        self.assertEqual(comparisons[2][2], 1)

    def test_stars_are_the_thesis_s(self):
        # Table 5.4: t of six comparisons, and its stars. Twelve participants leave 132 degrees.
        from scipy import stats

        for t, stars in ((2.926, "*"), (2.440, "ns"), (4.606, "***"), (2.870, "*"), (3.299, "**"), (2.562, "ns")):
            self.assertEqual(self.script.significance(6 * 2 * stats.t.sf(t, 132)), stars)

    def test_answers(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "answers.csv")

            def read(*rows):
                with open(path, "w", encoding="utf-8") as file:
                    file.write("\n".join(("participant,scene,red,green,blue,seconds", *rows)) + "\n")
                return self.script.read_answers(path)

            rows = ["p,ear,1,.5,.25,2", "p,nose,1,0,.5,3", "q,ear,1,1,1,2", "q,nose,.5,.5,.5,1"]
            scenes, participants, colors = read(*rows)
            self.assertEqual((scenes, participants), (["ear", "nose"], ["p", "q"]))
            self.assertEqual(colors[:, 0, 0].tolist(), [1, .5, .25])
            for row in ("p,ear,1,1,1", "p,ear,1,x,1,2", "p,ear,1,1,1.5,2", "p,ear,-1,1,1,2", "p,ear,1,1,1,2,3", "q,nose,1,1,1,2"):
                with self.assertRaisesRegex(self.script.Refused, r"csv:6"):
                    read(*rows, row)
            with self.assertRaisesRegex(self.script.Refused, '"q" has not answered scene "nose"'):
                read(*rows[:3])

    def test_shares_of_a_turntable(self):
        # By .0026 a frame: .005 and .01 are exceeded by every second and fourth frame.
        cosines = -.5 + .0026 * self.numpy.arange(400)
        necessary = self.numpy.arange(400) < 200
        shares = [self.script.coherent_share(cosines, t, n) for n in (None, necessary) for t in (.005, .01)]
        self.assertEqual(shares, [.5, .25, .25, .125])
        self.assertEqual(self.script.coherent_share([-.5, -.5, .5, -.5], .005, [True, True, False, True]), .5)

    def test_minimum_dots(self):
        # Light that grows from a dot of m on passes the threshold t of its maximum at m - t (1 + m).
        swings, expected = [], []
        for light, eyes in self.script.swing_directions(12, 900):
            m = -.4 - .3 * light[0]
            for dot, ways in eyes:
                for eye in ways:
                    self.assertAlmostEqual(float(light @ eye), dot, delta=1e-12)
            swings.append([(dot, max(0, (m - dot) / (1 + m))) for dot, _ in eyes])
            expected.append(m - .2 * (1 + m))
        for dot, right in zip(self.script.minimum_dots(swings, .2), expected):
            self.assertAlmostEqual(dot, right, delta=.5001e-4)
        self.assertEqual(self.script.minimum_dots([[(0, 1), (-1, 1)], [(0, 0), (-1, 0)]], .25), [0, -1])

    def test_polynomials_are_those_of_the_settings(self):
        with open(os.path.join(TOOLS, "../gbuffer_harness/replay/settings.cpp"), encoding="utf-8") as file:
            settings = file.read()
        for polynomial in (self.script.QUADRATIC, self.script.CUBIC):
            self.assertIn("{" + ", ".join(map(str, polynomial)), settings)


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
            self.script.save_textures(rd, controller, {"material": "Nothing", "albedo": "Buffer"}, self.folder.name)

    # Two draws and a pass after them. The first draw's camera is a struct; the second has a buffer of its own and the
    # newer PipeState.
    def replay(self):
        def matrix(name, first, members=()):
            return stand_in(name=name, rows=4, columns=4, members=list(members),
                            value=stand_in(f32v=[float(first + i) for i in range(16)]))

        camera = stand_in(name="camera", rows=0, columns=0, value=None,
                          members=[matrix("view", 100), matrix("projection", 200)])
        color = stand_in(name="color", rows=1, columns=4, members=[], value=None)
        contents = {("vs1", 1): [camera, color], ("vs2", 0): [matrix("viewProjection", 300)], ("cs", 0): [color]}
        stages = {"Vertex": {1: ("vs1", ["Object", "Frame"]), 2: ("vs2", ["Sun"])}, "Pixel": {},
                  "Compute": {3: ("cs", ["Post"])}}
        at = [0]

        def reflection(stage):
            shader = stages[stage].get(at[0])
            return shader and stand_in(resourceId=shader[0], constantBlocks=[stand_in(name=name) for name in shader[1]])

        def state():
            common = {"GetShaderReflection": reflection, "GetShaderEntryPoint": lambda stage: "main",
                      "GetGraphicsPipelineObject": lambda: "pipeline", "GetComputePipelineObject": lambda: "compute"}
            place = {"byteOffset": 16, "byteSize": 64}
            if at[0] == 2:
                return stand_in(GetConstantBlock=lambda stage, index, array: stand_in(
                    descriptor=stand_in(resource="buffer", **place)), **common)
            return stand_in(GetConstantBuffer=lambda stage, index, array: stand_in(resourceId="buffer", **place), **common)

        def variables(pipeline, shader, stage, entry, index, buffer, offset, size):
            self.assertEqual((pipeline, entry, buffer, offset, size),
                             ("compute" if stage == "Compute" else "pipeline", "main", "buffer", 16, 64))
            return contents[shader, index]

        actions = [stand_in(eventId=9, flags=0, children=[stand_in(eventId=i, flags=flag, children=[])
                                                          for i, flag in ((1, 1), (2, 1), (3, 2))])]
        rd = stand_in(ShaderStage=stand_in(Vertex="Vertex", Pixel="Pixel", Compute="Compute"),
                      ActionFlags=stand_in(Drawcall=1, Dispatch=2))
        return rd, stand_in(GetRootActions=lambda: actions, SetFrameEvent=lambda event, force: at.__setitem__(0, event),
                            GetPipelineState=state, GetCBufferVariableContents=variables)

    def test_matrices_come_from_named_constant_buffers(self):
        rd, controller = self.replay()
        wanted = {"viewFromWorld": ("Frame", "camera.view"), "clipFromView": ("Frame", "camera.projection"),
                  "shadowMap0.clipFromWorld": ("Sun", "viewProjection")}
        found = self.script.read_matrices(rd, controller, wanted, 3)
        columns = [100.0 + 4 * row + column for column in range(4) for row in range(4)]
        self.assertEqual(found["viewFromWorld"], columns)
        self.assertEqual(found["shadowMap0.clipFromWorld"], [value + 200 for value in columns])
        files = {"frontDepth": "frontDepth.exr", "shadowMap0": "shadowMap0.exr"}
        manifest = self.script.manifest_skeleton(files)
        self.script.put_matrices(manifest, files, found)
        self.assertEqual(manifest["camera"]["clipFromView"], [value + 100 for value in columns])
        self.assertEqual(manifest["lights"][0]["shadowMap"]["clipFromWorld"], found["shadowMap0.clipFromWorld"])
        self.script.ROW_VECTORS = True
        self.addCleanup(setattr, self.script, "ROW_VECTORS", False)
        self.assertEqual(self.script.read_matrices(rd, controller, {"viewFromWorld": ("Frame", "camera.view")}, 3),
                         {"viewFromWorld": [100.0 + i for i in range(16)]})

    def test_matrices_that_are_not_there_are_named(self):
        rd, controller = self.replay()

        def refused(pattern, wanted, last=3):
            with self.assertRaisesRegex(ValueError, pattern):
                self.script.read_matrices(rd, controller, {"viewFromWorld": wanted}, last)

        refused("name Camera; there are Frame, Object, Post, Sun", ("Camera", "view"))
        refused("name Sun; there are Frame, Object", ("Sun", "viewProjection"), last=1)
        refused(r"Frame: no variable has the name camera.world; there are view \(4 x 4\), projection",
                ("Frame", "camera.world"))
        refused("Frame: color is 1 x 4, not a matrix", ("Frame", "color"))
        with self.assertRaisesRegex(ValueError, "shadowMap1.clipFromWorld: not clipFromView.*shadowMap0"):
            self.script.put_matrices(self.script.manifest_skeleton({"shadowMap0": "a.exr"}), {"shadowMap0": "a.exr"},
                                     {"shadowMap1.clipFromWorld": []})


class Blender(unittest.TestCase):
    def setUp(self):
        self.script = importlib.import_module("blender_export")

        def thing(matrix_world, **attributes):
            made = stand_in(hide_render=False, matrix_world=matrix_world, **attributes)
            made.evaluated_get = lambda depsgraph: made
            return made

        def material(index, preset):
            made = stand_in(pass_index=index)
            made.get = lambda key, default: preset or default
            return made

        spot = stand_in(type="SPOT", color=(1, 1, 1), energy=100.0, spot_size=0.8, spot_blend=0.25)
        sun = stand_in(type="SUN", color=(0, 0, 1), energy=3.0)
        area = stand_in(type="AREA", color=(1, 1, 1), energy=5.0)
        # Of calc_matrix_camera(): OpenGL, here with a shift and clip distances 0.1 and 100. The camera has a scale of 2.
        near, far = 0.1, 100
        projection = [[2, 0, 0.2, 0], [0, 4, -0.1, 0],
                      [0, 0, -(far + near) / (far - near), -2 * far * near / (far - near)], [0, 0, -1, 0]]
        camera = thing([[2, 0, 0, 1], [0, 2, 0, 2], [0, 0, 2, 5], [0, 0, 0, 1]], type="CAMERA", name="Camera",
                       calc_matrix_camera=lambda depsgraph, x, y, scale_x, scale_y: projection)
        scene = stand_in(
            camera=camera, unit_settings=stand_in(scale_length=0.5), frame_start=1, frame_end=2,
            frame_set=lambda frame: None,
            objects=[camera, thing([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 9], [0, 0, 0, 1]], type="LIGHT", name="Sun", data=sun),
                     thing([[0, 0, 1, 7], [0, 1, 0, 8], [-1, 0, 0, 9], [0, 0, 0, 1]], type="LIGHT", name="Spot", data=spot),
                     thing(IDENTITY, type="LIGHT", name="Box", data=area)],
            render=stand_in(resolution_x=16, resolution_y=9, pixel_aspect_x=1, pixel_aspect_y=1))
        self.bpy = stand_in(data=stand_in(materials=[material(0, None), material(7, "marble"), material(3, None)]),
                            context=stand_in(scene=scene, evaluated_depsgraph_get=lambda: None,
                                             view_layer=stand_in(name="View")))

    def test_camera_is_vulkans_and_without_scale(self):
        camera = self.script.manifest(self.bpy, "render.exr")["camera"]
        self.assertEqual(camera["viewFromWorld"], [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, -2, -5, 1])
        m, point = camera["clipFromView"], (0.5, -0.25, -5, 1)
        x, y, z, w = (sum(m[4 * column + row] * point[column] for column in range(4)) for row in range(4))
        self.assertAlmostEqual(w, 5)
        self.assertAlmostEqual(x, 2 * 0.5 + 0.2 * -5)
        self.assertAlmostEqual(y, -(4 * -0.25 - 0.1 * -5))
        self.assertAlmostEqual((m[10] * -0.1 + m[14]) / 0.1, 0)
        self.assertAlmostEqual((m[10] * -100 + m[14]) / 100, 1)

    def test_lights_have_pellucids_units(self):
        sun, spot = self.script.manifest(self.bpy, "render.exr")["lights"]
        self.assertEqual(sun, {"type": "directional", "color": [0, 0, 1], "intensity": 3, "direction": [0, 0, -1]})
        self.assertAlmostEqual(spot["intensity"], 100 / (4 * math.pi))
        self.assertEqual(spot["position"], [7, 8, 9])
        self.assertEqual(spot["direction"], [-1, 0, 0])
        self.assertAlmostEqual(spot["outerConeAngle"], 0.4)
        self.assertAlmostEqual(spot["innerConeAngle"], 0.3)

    def test_manifests_are_those_of_captures(self):
        with tempfile.TemporaryDirectory() as folder:
            self.script.export(self.bpy, os.path.join(folder, "r.###.json"))
            self.script.export(self.bpy, os.path.join(folder, "still.json"))
            self.assertEqual(sorted(os.listdir(folder)), ["r.001.json", "r.002.json", "still.json"])
            with open(os.path.join(folder, "r.002.json"), encoding="utf-8") as file:
                written = json.load(file)
            self.assertEqual(written["buffers"]["material"],
                             {"file": "r.002.exr", "channel": "View.IndexMA.X", "map": {"0": 0, "7": 1, "3": 2}})
            self.assertEqual(written["materials"], [{"preset": "marble"}, {"preset": "skin1"}])
            run = subprocess.run([COMMAND, "info", os.path.join(folder, "still.json")], capture_output=True, text=True,
                                 check=False)
            self.assertIn("still.exr", run.stderr)  # the manifest is whole, the pixels are not there


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
