"""Makes scenes of slabs for blender_capture_test.py, in Blender.

    blender -b -P blender_materials.py -- materials FILE.blend    pairs of one medium: by nodes, and by plain numbers
    blender -b -P blender_materials.py -- occluders FILE.blend    opaque bodies before, inside and behind a slab
    blender -b -P blender_materials.py -- mixed FILE.blend        a slab of which a part alone scatters
    blender -b -P blender_materials.py -- anisotropic FILE.blend  a slab that scatters forwards
"""
import math
import sys

import bpy
from mathutils import Vector

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.unit_settings.scale_length = 0.001


def box(name, material, center, size):
    bpy.ops.mesh.primitive_cube_add(size=1, location=center, scale=size)
    bpy.context.object.name = name
    bpy.context.object.data.materials.append(material)


def principled(name, **inputs):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    node = material.node_tree.nodes["Principled BSDF"]
    node.inputs["Specular"].default_value = 0
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    return material, node


def new(tree, kind, **settings):
    node = tree.nodes.new(kind)
    for key, value in settings.items():
        setattr(node, key, value)
    return node


def value(tree, number):
    node = new(tree, "ShaderNodeValue")
    node.outputs[0].default_value = number
    return node.outputs[0]


def color(tree, rgb):
    node = new(tree, "ShaderNodeRGB")
    node.outputs[0].default_value = (*rgb, 1)
    return node.outputs[0]


def by_weight():
    """Two colors, and a weight that a calculation gives."""
    material, node = principled("by weight", Base_Color=(0.2, 0.7, 0.3, 1), Subsurface_Color=(0.9, 0.3, 0.6, 1),
                                Subsurface_Radius=(10, 5, 2.5))
    tree = material.node_tree
    math_node = new(tree, "ShaderNodeMath", operation="MULTIPLY")
    math_node.inputs[1].default_value = 0.5
    tree.links.new(value(tree, 0.8), math_node.inputs[0])
    tree.links.new(math_node.outputs[0], node.inputs["Subsurface"])
    mixed = [0.6 * a + 0.4 * b for a, b in zip((0.2, 0.7, 0.3), (0.9, 0.3, 0.6))]
    plain = principled("plain weight", Base_Color=(*mixed, 1), Subsurface_Color=(*mixed, 1), Subsurface=1,
                       Subsurface_Radius=(4, 2, 1))[0]
    return material, plain


def by_group():
    """A group within a group, whose inner radius comes from outside, past a reroute; beside it a mix that shows nothing."""
    inner = bpy.data.node_groups.new("inner", "ShaderNodeTree")
    inner.inputs.new("NodeSocketVector", "Radius")
    inner.outputs.new("NodeSocketShader", "Surface")
    inside, end = new(inner, "NodeGroupInput"), new(inner, "NodeGroupOutput")
    leaf = new(inner, "ShaderNodeSubsurfaceScattering", falloff="RANDOM_WALK")
    leaf.inputs["Color"].default_value = (0.8, 0.5, 0.3, 1)
    leaf.inputs["Scale"].default_value = 2
    leaf.inputs["IOR"].default_value = 1.3
    inner.links.new(inside.outputs["Radius"], leaf.inputs["Radius"])
    inner.links.new(leaf.outputs[0], end.inputs["Surface"])
    outer = bpy.data.node_groups.new("outer", "ShaderNodeTree")
    outer.outputs.new("NodeSocketShader", "Surface")
    group, end, past = new(outer, "ShaderNodeGroup"), new(outer, "NodeGroupOutput"), new(outer, "NodeReroute")
    group.node_tree = inner
    outer.links.new(color(outer, (3, 1.5, 0.8)), past.inputs[0])
    outer.links.new(past.outputs[0], group.inputs["Radius"])
    outer.links.new(group.outputs[0], end.inputs["Surface"])
    material = bpy.data.materials.new("by group")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    group, mix = new(tree, "ShaderNodeGroup"), new(tree, "ShaderNodeMixShader")
    group.node_tree = outer
    mix.inputs[0].default_value = 0
    tree.links.new(group.outputs[0], mix.inputs[1])
    tree.links.new(new(tree, "ShaderNodeBsdfDiffuse").outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    plain = principled("plain group", Base_Color=(0.8, 0.5, 0.3, 1), Subsurface_Color=(0.8, 0.5, 0.3, 1), Subsurface=1,
                       Subsurface_Radius=(6, 3, 1.6), Subsurface_IOR=1.3)[0]
    return material, plain


def sun(direction, energy):
    data = bpy.data.lights.new("sun", "SUN")
    data.energy, data.angle = energy, 0
    thing = bpy.data.objects.new("sun", data)
    scene.collection.objects.link(thing)
    thing.rotation_euler = Vector(direction).to_track_quat("-Z", "Y").to_euler()


def camera(width):
    data = bpy.data.cameras.new("camera")
    data.type, data.ortho_scale, data.clip_start, data.clip_end = "ORTHO", width, 1, 100
    scene.camera = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(scene.camera)
    scene.camera.location = (0, 0, 40)
    scene.render.resolution_x = scene.render.resolution_y = 48


what, path = sys.argv[sys.argv.index("--") + 1:]
wax = principled("wax", Base_Color=(0.8, 0.5, 0.3, 1), Subsurface_Color=(0.8, 0.5, 0.3, 1), Subsurface=1,
                 Subsurface_Radius=(4, 2, 1))[0]
if what == "materials":
    for i, material in enumerate(by_weight() + by_group()):
        box(material.name, material, ((i % 2 - 0.5) * 11, (i // 2 - 0.5) * 11, 0), (10, 10, 3))
    sun((0.2, 0.1, -1), 3)
    sun((0, 0, 1), 6)
    camera(24)
elif what == "anisotropic":
    wax.node_tree.nodes["Principled BSDF"].inputs["Subsurface Anisotropy"].default_value = 0.8
    box("slab", wax, (0, 0, 0), (40, 40, 2))
    sun((0, 0, 1), 6)
    camera(20)
elif what == "occluders":
    stone = principled("stone", Base_Color=(0.2, 0.2, 0.2, 1))[0]
    box("slab", wax, (0, 0, 0), (30, 30, 3))
    box("behind", stone, (-8, 0, -4), (6, 20, 0.5))
    box("inside", stone, (8, 0, 0), (6, 20, 0.4))
    sun((0, 0, 1), 8)
    camera(24)
else:
    tree = wax.node_tree
    mix, stays = new(tree, "ShaderNodeMixShader"), new(tree, "ShaderNodeBsdfDiffuse")
    stays.inputs["Color"].default_value = (0.2, 0.6, 0.2, 1)
    mix.inputs[0].default_value = 0.4
    tree.links.new(tree.nodes["Principled BSDF"].outputs[0], mix.inputs[1])
    tree.links.new(stays.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    box("slab", wax, (0, 0, 0), (30, 30, 2))
    sun((0.2, 0.1, -1), 1)
    sun((0, 0, 1), 6)
    camera(20)
    # A sheet that shines to one side, in the scene, and a spot of half a sphere.
    for kind, more in (("AREA", {"size": 1}), ("SPOT", {"spot_size": math.pi, "shadow_soft_size": 0})):
        data = bpy.data.lights.new(kind, kind)
        data.energy = 4000
        for key, setting in more.items():
            setattr(data, key, setting)
        thing = bpy.data.objects.new(kind, data)
        scene.collection.objects.link(thing)
        thing.location, thing.rotation_euler = (0, 0, -20), (math.pi, 0, 0)
bpy.ops.wm.save_as_mainfile(filepath=path)
