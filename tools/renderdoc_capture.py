"""Saves textures of a RenderDoc capture as EXR files and begins a Pellucid manifest for them.

Name your engine's textures below, then run this in RenderDoc's own Python: in its Python shell with a
capture open (or `qrenderdoc --python renderdoc_capture.py frame.rdc`), or where its `renderdoc` module can be
imported: python3 renderdoc_capture.py frame.rdc.  `pellucid info FOLDER/manifest.json` then names what is
still to be filled in: matrices (null) and whatever has no texture.  docs/scenes.md has the recipe.
"""
import json
import os
import sys

# Manifest buffer -> name of the texture in RenderDoc's resource list; leave out what there is not. A light's
# shadow map is "shadowMap0", "shadowMap1", ...
TEXTURES = {
    "frontDepth": "SceneDepth",
    "irradiance": "DiffuseLighting",
    "normal": "GBufferNormal",
    "albedo": "GBufferAlbedo",
    "material": "GBufferMaterialId",
    "shadowMap0": "SunShadowMap",
}
EVENT = None  # event whose result is saved; None: the end of the frame
FOLDER = "pellucid_capture"

# RenderDoc writes channels R, G, B, A, whatever the texture has.
BUFFERS = {
    "frontDepth": {"channel": "R", "encoding": "device"},
    "backDepth": {"channel": "R", "encoding": "device"},
    "irradiance": {"channels": ["R", "G", "B"]},
    "normal": {"channels": ["R", "G", "B"], "space": "world"},
    "albedo": {"channels": ["R", "G", "B"]},
    "material": {"channel": "R"},
}
SHADOW = "shadowMap"


def manifest_skeleton(files):
    """Manifest of `files` (buffer or shadowMap<i> -> EXR beside it); null is what a texture does not say."""
    manifest = {"pellucid": 1, "metersPerUnit": 1, "camera": {"clipFromView": None, "viewFromWorld": None},
                "buffers": {}, "lights": [], "materials": [{"preset": "skin1"}]}
    for name in sorted(files, key=lambda name: (name.startswith(SHADOW), len(name), name)):
        if name in BUFFERS:
            manifest["buffers"][name] = {"file": files[name], **BUFFERS[name]}
        elif name.startswith(SHADOW) and name[len(SHADOW):].isdigit():
            manifest["lights"].append({"type": "directional", "direction": None, "intensity": None,
                                       "shadowMap": {"file": files[name], "channel": "R", "encoding": "device",
                                                     "clipFromWorld": None}})
        else:
            raise ValueError(f"{name}: not one of {', '.join(BUFFERS)}, {SHADOW}0, {SHADOW}1, ...")
    return manifest


def save_textures(rd, controller, textures, folder):
    """Writes FOLDER/<buffer>.exr for each of `textures`; returns the files as manifest_skeleton takes them."""
    names = {resource.name: resource.resourceId for resource in controller.GetResources()}
    missing = [texture for texture in textures.values() if texture not in names]
    if missing:
        raise ValueError(f"no resource is named {', '.join(missing)}")
    files = {}
    for buffer, texture in textures.items():
        save = rd.TextureSave()
        save.resourceId = names[texture]
        save.mip = 0
        save.slice.sliceIndex = 0
        save.alpha = rd.AlphaMapping.Preserve
        save.destType = rd.FileType.EXR
        files[buffer] = buffer + ".exr"
        path = os.path.join(folder, files[buffer])
        controller.SaveTexture(save, path)
        if not os.path.exists(path):
            raise RuntimeError(f"RenderDoc did not write {texture} to {path}")
    return files


def last_event(actions):
    last = actions[-1]
    return last_event(last.children) if last.children else last.eventId


def capture(rd, controller):
    os.makedirs(FOLDER, exist_ok=True)
    controller.SetFrameEvent(last_event(controller.GetRootActions()) if EVENT is None else EVENT, True)
    manifest = manifest_skeleton(save_textures(rd, controller, TEXTURES, FOLDER))
    with open(os.path.join(FOLDER, "manifest.json"), "w", encoding="utf-8") as file:
        json.dump(manifest, file, indent=1)


def open_and_capture(rd, path):
    rd.InitialiseReplay(rd.GlobalEnvironment(), [])
    capture_file = rd.OpenCaptureFile()
    if capture_file.OpenFile(path, "", None) != rd.ResultCode.Succeeded:
        raise RuntimeError(f"{path}: cannot be opened")
    result, controller = capture_file.OpenCapture(rd.ReplayOptions(), None)
    if result != rd.ResultCode.Succeeded:
        raise RuntimeError(f"{path}: cannot be replayed here: {result}")
    capture(rd, controller)
    controller.Shutdown()
    capture_file.Shutdown()
    rd.ShutdownReplay()


if "pyrenderdoc" in globals():  # RenderDoc's own shell, where renderdoc is a global, too
    pyrenderdoc.Replay().BlockInvoke(lambda controller: capture(renderdoc, controller))
elif __name__ == "__main__":
    import renderdoc
    open_and_capture(renderdoc, sys.argv[1])
