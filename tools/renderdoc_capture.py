"""Saves textures of a RenderDoc capture as EXR files and begins a Pellucid manifest for them.

Name your engine's textures below, then run this in RenderDoc's own Python: in its Python shell with a capture open (or
`qrenderdoc --ui-python renderdoc_capture.py frame.rdc`: `--python` runs before the capture is loaded), or where its
`renderdoc` module can be imported: python3 renderdoc_capture.py frame.rdc.  `pellucid info FOLDER/manifest.json` then
names what is still to be filled in: matrices that MATRICES does not name (null) and whatever has no texture. `pellucid
init FOLDER/*.exr` asks for the camera's numbers instead of its matrices.  docs/captures.md has the recipe.
"""
import json
import os
import sys

# Manifest buffer -> name of the texture in RenderDoc's resource list, or the number of its resource id (1234, or
# "ResourceId::1234"); leave out what there is not. A light's
# shadow map is "shadowMap0", "shadowMap1", ...
TEXTURES = {
    "frontDepth": "SceneDepth",
    "irradiance": "DiffuseLighting",
    "albedo": "GBufferAlbedo",
    "material": "GBufferMaterialId",
    "shadowMap0": "SunShadowMap",
}
# Matrix of the manifest -> constant buffer, as the shader names it, and variable in it ("camera.projection" of a
# struct). They are read at the last draw or dispatch up to EVENT whose shaders have that buffer. Leave out what there is
# not. "clipFromView", "viewFromWorld", and of a shadow map "shadowMap0.clipFromWorld" and "shadowMap0.viewFromWorld".
MATRICES = {
    # "clipFromView": ("Camera", "projection"),
    # "viewFromWorld": ("Camera", "view"),
    # "shadowMap0.clipFromWorld": ("Sun", "viewProjection"),
}
ROW_VECTORS = False  # True: shaders multiply mul(vector, matrix), so that the matrices are transposed
EVENT = None  # event whose result is saved; None: the end of the frame
FOLDER = "pellucid_capture"

# RenderDoc writes channels R, G, B, A, whatever the texture has.
BUFFERS = {
    "frontDepth": {"channel": "R", "encoding": "device"},
    "backDepth": {"channel": "R", "encoding": "device"},
    "irradiance": {"channels": ["R", "G", "B"]},
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


def number_of(resource_id):
    """The number that RenderDoc shows of a resource id, as "ResourceId::1234"."""
    return str(resource_id).rpartition("::")[2]


def find_textures(controller, wanted):
    """Names or numbers -> resource ids. The error lists what there is."""
    names = {number_of(resource.resourceId): resource.name for resource in controller.GetResources()}
    textures = {number_of(texture.resourceId): texture for texture in controller.GetTextures()}
    found, missing = {}, []
    for name in wanted:
        number = number_of(name)
        # The last of a name is what the frame ends with, where an engine makes it anew.
        numbers = [key for key in textures if key == number or names.get(key) == name]
        if numbers:
            found[name] = textures[numbers[-1]].resourceId
        else:
            missing.append(str(name))
    if missing:
        lines = [f"  {key}: {names.get(key, '')}, {texture.width} x {texture.height}, {texture.format.Name()}"
                 for key, texture in textures.items()]
        raise ValueError("no texture has the name or number " + ", ".join(missing) + "; there are\n" + "\n".join(lines))
    return found


def save_textures(rd, controller, textures, folder):
    """Writes FOLDER/<buffer>.exr for each of `textures`; returns the files as manifest_skeleton takes them."""
    ids = find_textures(controller, textures.values())
    files = {}
    for buffer, texture in textures.items():
        save = rd.TextureSave()
        save.resourceId = ids[texture]
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


def constant_blocks(rd, controller):
    """(stage, reflection, index, block) of each constant buffer of the shaders at the current event."""
    state = controller.GetPipelineState()
    for stage in (rd.ShaderStage.Vertex, rd.ShaderStage.Pixel, rd.ShaderStage.Compute):
        reflection = state.GetShaderReflection(stage)
        if reflection is not None:
            for index, block in enumerate(reflection.constantBlocks):
                yield stage, reflection, index, block


def variables_of(rd, controller, stage, reflection, index):
    """The contents of one constant buffer."""
    state = controller.GetPipelineState()
    if hasattr(state, "GetConstantBuffer"):
        bound = state.GetConstantBuffer(stage, index, 0)
        place = (bound.resourceId, bound.byteOffset, bound.byteSize)
    else:  # RenderDoc 1.32
        bound = state.GetConstantBlock(stage, index, 0).descriptor
        place = (bound.resource, bound.byteOffset, bound.byteSize)
    pipeline = state.GetComputePipelineObject() if stage == rd.ShaderStage.Compute else state.GetGraphicsPipelineObject()
    return controller.GetCBufferVariableContents(pipeline, reflection.resourceId, stage,
                                                 state.GetShaderEntryPoint(stage), index, *place)


def find_variable(variables, path, block):
    """The matrix at "a.b" of a constant buffer, column-major. The error lists what there is."""
    found, level = None, list(variables)
    for part in path.split("."):
        found = next((variable for variable in level if variable.name == part), None)
        if found is None:
            there = ", ".join(f"{variable.name} ({variable.rows} x {variable.columns})" for variable in level)
            raise ValueError(f"{block}: no variable has the name {path}; there are {there}")
        level = list(found.members)
    if (found.rows, found.columns) != (4, 4):
        raise ValueError(f"{block}: {path} is {found.rows} x {found.columns}, not a matrix of 4 x 4")
    rows = [list(found.value.f32v[4 * row:4 * row + 4]) for row in range(4)]  # whatever the buffer's own order
    return sum(rows if ROW_VECTORS else [list(column) for column in zip(*rows)], [])


def draws(actions, flags):
    """Events of draws and dispatches, in their order."""
    for action in actions:
        yield from draws(action.children, flags)
        if action.flags & flags:
            yield action.eventId


def read_matrices(rd, controller, matrices, last):
    """Reads MATRICES at or before the event `last`; name -> 16 numbers, column-major."""
    wanted, found, seen = dict(matrices), {}, set()
    events = draws(controller.GetRootActions(), rd.ActionFlags.Drawcall | rd.ActionFlags.Dispatch)
    for event in sorted((event for event in events if event <= last), reverse=True):
        if not wanted:
            break
        controller.SetFrameEvent(event, False)
        for stage, reflection, index, block in constant_blocks(rd, controller):
            seen.add(block.name)
            names = [name for name, (buffer, _) in wanted.items() if buffer == block.name]
            variables = variables_of(rd, controller, stage, reflection, index) if names else []
            for name in names:
                found[name] = find_variable(variables, wanted.pop(name)[1], block.name)
    if wanted:
        buffers = ", ".join(sorted({buffer for buffer, _ in wanted.values()}))
        raise ValueError(f"no shader has a constant buffer of the name {buffers}; there are {', '.join(sorted(seen))}")
    return found


def put_matrices(manifest, files, matrices):
    """Writes what read_matrices() found in place of null."""
    shadow_maps = sorted((name for name in files if name.startswith(SHADOW)), key=lambda name: (len(name), name))
    for name, matrix in matrices.items():
        light, _, key = name.rpartition(".")
        if name in manifest["camera"]:
            manifest["camera"][name] = matrix
        elif light in shadow_maps and key in ("clipFromWorld", "viewFromWorld"):
            manifest["lights"][shadow_maps.index(light)]["shadowMap"][key] = matrix
        else:
            raise ValueError(f"{name}: not clipFromView, viewFromWorld, or clipFromWorld or viewFromWorld of one of "
                             f"{', '.join(shadow_maps) or 'no shadow map'}")


def last_event(actions):
    last = actions[-1]
    return last_event(last.children) if last.children else last.eventId


def capture(rd, controller):
    os.makedirs(FOLDER, exist_ok=True)
    event = last_event(controller.GetRootActions()) if EVENT is None else EVENT
    controller.SetFrameEvent(event, True)
    files = save_textures(rd, controller, TEXTURES, FOLDER)
    manifest = manifest_skeleton(files)
    put_matrices(manifest, files, read_matrices(rd, controller, MATRICES, event))
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


def capture_in_shell(rd, context):
    if not context.IsCaptureLoaded():
        raise RuntimeError("no capture is loaded: open one, or give the script with --ui-python, which runs after loading")
    context.Replay().BlockInvoke(lambda controller: capture(rd, controller))


if "pyrenderdoc" in globals():  # RenderDoc's own shell, where renderdoc is a global, too
    capture_in_shell(renderdoc, pyrenderdoc)
elif __name__ == "__main__":
    import renderdoc
    if len(sys.argv) != 2:
        raise SystemExit("usage: python3 renderdoc_capture.py frame.rdc")
    open_and_capture(renderdoc, sys.argv[1])
