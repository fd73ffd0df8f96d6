"""tools/renderdoc_capture.py on a frame that RenderDoc captures of the sample renderer.

    xvfb-run -a python3 renderdoc_run_test.py SAMPLE TOOLS_FOLDER PELLUCID_COMMAND
"""
import importlib
import json
import os
import re
import subprocess
import sys
import tempfile
import time
import unittest

import renderdoc as rd

sys.dont_write_bytecode = True
SAMPLE, TOOLS, COMMAND = (os.path.abspath(path) for path in sys.argv[1:4])
SIDE, FRAME, SECONDS = 160, 3, 120


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def capture_frame(folder):
    """The sample draws a few frames in a window; RenderDoc's file of one of them."""
    options = f"--frames 8 --width {SIDE} --height {SIDE} --shadow-size 128 --cell 8"
    started = rd.ExecuteAndInject(SAMPLE, "", options, [], os.path.join(folder, "frame"), rd.GetDefaultCaptureOptions(), False)
    target = rd.CreateTargetControl("", started.ident, "test", True)
    if target is None:
        raise AssertionError("the sample ended before RenderDoc reached it")
    target.QueueCapture(FRAME, 1)
    path, end = None, time.time() + SECONDS
    while target.Connected() and time.time() < end:
        message = target.ReceiveMessage(None)
        if message.type == rd.TargetControlMessageType.NewCapture:
            path = message.newCapture.path
        if message.type == rd.TargetControlMessageType.Disconnected:
            break
    target.Shutdown()
    if path is None:
        raise AssertionError(f"no capture after {SECONDS} seconds")
    return path


class RenderDocRun(unittest.TestCase):
    def test_a_frame_becomes_a_picture_with_translucency(self):
        sys.path.insert(0, TOOLS)
        script = importlib.import_module("renderdoc_capture")
        rd.InitialiseReplay(rd.GlobalEnvironment(), [])
        with tempfile.TemporaryDirectory() as folder:
            frame = capture_frame(folder)
            script.FOLDER = os.path.join(folder, "out")
            # Names that the frame has not are answered with what it has.
            with self.assertRaises(ValueError) as raised:
                script.open_and_capture(rd, frame)
            listed = re.findall(rf"^ *(\d+): .*, {SIDE} x {SIDE}, (\w+)$", str(raised.exception), re.MULTILINE)
            ids = {kind: [int(number) for number, of in listed if of == kind] for _, kind in listed}
            script.TEXTURES = {"frontDepth": ids["D32"][0], "backDepth": ids["D32"][1], "material": ids["R32_UINT"][0],
                               "irradiance": ids["R16G16B16A16_FLOAT"][0]}
            script.open_and_capture(rd, frame)
            # Two commands to a picture: the script's textures need the camera and a light.
            manifest, picture = os.path.join(script.FOLDER, "capture.json"), os.path.join(folder, "picture.exr")
            textures = [os.path.join(script.FOLDER, name + ".exr") for name in script.TEXTURES]
            said = run(COMMAND, "init", *textures, "--fov", "30", "--reversed-z", "--near", "0.1", "--light",
                       "directional:0,0,1:3", "-o", manifest)
            self.assertIn("next: pellucid replay", said)
            self.assertNotIn("directional:X,Y,Z:E", said)
            run(COMMAND, "replay", manifest, "--repeat", "0", "-o", picture)
            difference = json.loads(run(COMMAND, "compare", picture, textures[3], "--mask", manifest, "--json"))
            self.assertGreater(difference["pixels"], SIDE * SIDE // 8)
            self.assertEqual(difference["nonFinite"], {"a": 0, "b": 0})
            self.assertGreater(min(difference["rel_rmse"]), 0.01)  # the picture is not what went in


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
