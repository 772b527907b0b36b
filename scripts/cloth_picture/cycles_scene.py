"""Run by Blender, where cycles.py has written scene.json and arrays.npz: builds that scene, and draws it."""
import json
import os

import bmesh
import bpy
import numpy as np
from mathutils import Matrix, Vector

BOUNCES = 2  # between surfaces, as many as radiosity has in povray.py
FAR = 500.0  # m, half of a plane's side
ROUND = 128  # sides of what is round


def image(name, pixels):
    """Of linear values, the first row on top. @param pixels (row, column) or (row, column, 3)"""
    colours = np.ones((*pixels.shape[:2], 4), dtype=np.float32)
    colours[..., :3] = pixels[::-1] if pixels.ndim == 3 else pixels[::-1, :, None]
    made = bpy.data.images.new(name, pixels.shape[1], pixels.shape[0], float_buffer=True)
    made.colorspace_settings.name = 'Non-Color'
    made.pixels.foreach_set(colours.ravel())
    made.update()
    return made


class Nodes:
    """Of a material or of the world, emptied."""

    def __init__(self, owner):
        owner.use_nodes = True
        self.tree = owner.node_tree
        self.tree.nodes.clear()

    def add(self, kind, inputs=None, **settings):
        """@param inputs by name or number: values, or outputs of other nodes"""
        node = self.tree.nodes.new(kind)
        for key, value in settings.items():
            setattr(node, key, value)
        for key, value in (inputs or {}).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node


def sloping(nodes, slopes):
    """The normal, tilted. Blender's own bumps are differences between pixels, and lie half of one aside."""
    normal = nodes.add('ShaderNodeNewGeometry').outputs['Normal']
    slopes = nodes.add('ShaderNodeSeparateXYZ', {0: slopes})
    for key, slope in (('weft', 'X'), ('warp', 'Y')):
        growth = nodes.add('ShaderNodeAttribute', attribute_name=key).outputs['Vector']
        tilt = nodes.add('ShaderNodeVectorMath', {0: growth, 'Scale': slopes.outputs[slope]}, operation='SCALE')
        normal = nodes.add('ShaderNodeVectorMath', {0: normal, 1: tilt.outputs[0]}, operation='SUBTRACT').outputs[0]
    return nodes.add('ShaderNodeVectorMath', {0: normal}, operation='NORMALIZE').outputs[0]


def material_of(number, what, arrays):
    """Lambert's in its colour and a highlight in the light's, of facets with Beckmann's distribution, from which povray.py
    derives its own. Alpha is the square of Blender's roughness."""
    material = bpy.data.materials.new(f'material_{number}')
    nodes = Nodes(material)
    normal = {}
    if 'slopes' in what:
        pictures = (image(f'{key}_{number}', arrays[what[key]]) for key in ('colours', 'slopes'))
        colour, slopes = (nodes.add('ShaderNodeTexImage', image=picture).outputs['Color'] for picture in pictures)
        normal = {'Normal': sloping(nodes, slopes)}
    else:
        colour = (*what['colour'], 1.0)
    shader = nodes.add('ShaderNodeBsdfDiffuse', {'Color': colour, **normal})
    if what['gloss'] > 0.0:
        highlight = nodes.add('ShaderNodeBsdfGlossy', {'Color': (1.0, 1.0, 1.0, 1.0), 'Roughness': what['width'] ** 0.5,
                                                       **normal}, distribution='BECKMANN')
        shader = nodes.add('ShaderNodeMixShader', {0: what['gloss'], 1: shader.outputs[0], 2: highlight.outputs[0]})
    nodes.add('ShaderNodeOutputMaterial', {'Surface': shader.outputs[0]})
    return material


def fill_surface(mesh, what, arrays):
    positions, triangles = arrays[what['positions']], arrays[what['triangles']]
    mesh.vertices.add(len(positions))
    mesh.vertices.foreach_set('co', positions.astype(np.float32).ravel())
    mesh.loops.add(triangles.size)
    mesh.loops.foreach_set('vertex_index', triangles.astype(np.int32).ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set('loop_start', 3 * np.arange(len(triangles), dtype=np.int32))
    mesh.polygons.foreach_set('loop_total', np.full(len(triangles), 3, dtype=np.int32))
    mesh.polygons.foreach_set('use_smooth', np.ones(len(triangles), dtype=bool))
    if 'material_of' in what:
        mesh.polygons.foreach_set('material_index', arrays[what['material_of']].astype(np.int32))
    if 'pieces' in what:
        mesh.uv_layers.new().data.foreach_set('uv', arrays[what['pieces']].astype(np.float32).ravel())
        for key in ('weft', 'warp'):
            growth = mesh.attributes.new(key, 'FLOAT_VECTOR', 'FACE')
            growth.data.foreach_set('vector', arrays[what[key]].astype(np.float32).ravel())
    mesh.update(calc_edges=True)
    mesh.use_auto_smooth = True
    mesh.normals_split_custom_set_from_vertices(arrays[what['normals']])


def fill_shape(mesh, what):
    """In its own axes, as cloth_picture.solids.Solid says."""
    kind, sizes, shape = what['kind'], what['sizes'], bmesh.new()

    def ball(height):
        bmesh.ops.create_uvsphere(shape, u_segments=ROUND, v_segments=ROUND // 2, radius=sizes[0],
                                  matrix=Matrix.Translation((0.0, 0.0, height)))
    if kind == 'sphere':
        ball(0.0)
    elif kind in ('capsule', 'cylinder'):
        bmesh.ops.create_cone(shape, cap_ends=kind == 'cylinder', segments=ROUND, radius1=sizes[0], radius2=sizes[0],
                              depth=sizes[1])
        for height in (-0.5 * sizes[1], 0.5 * sizes[1]) if kind == 'capsule' else ():
            ball(height)
    elif kind == 'box':
        bmesh.ops.create_cube(shape, size=1.0, matrix=Matrix.Diagonal((*sizes, 1.0)))
    elif kind == 'plane':
        bmesh.ops.create_grid(shape, x_segments=1, y_segments=1, size=FAR)
    for face in shape.faces:
        face.smooth = True
    shape.to_mesh(mesh)
    shape.free()
    mesh.use_auto_smooth = True  # smooth but for the edges of boxes and of cylinders' ends


def add_object(number, what, arrays):
    mesh = bpy.data.meshes.new(f'mesh_{number}')
    made = bpy.data.objects.new(f'object_{number}', mesh)
    if what['kind'] == 'mesh':
        fill_surface(mesh, what, arrays)
    else:
        fill_shape(mesh, what)
        made.matrix_world = Matrix(what['pose'])
    for place, material in enumerate(what['materials']):
        mesh.materials.append(material_of(f'{number}_{place}', material, arrays))
    made.visible_glossy = False  # highlights are those of the sun alone, as in povray.py
    bpy.context.scene.collection.objects.link(made)


def add_camera(what):
    camera = bpy.data.cameras.new('camera')
    camera.sensor_fit, camera.angle = 'HORIZONTAL', what['angle']
    camera.clip_start, camera.clip_end = 1e-4, 2.0 * FAR
    made = bpy.data.objects.new('camera', camera)
    made.matrix_world = Matrix(what['pose'])
    bpy.context.scene.collection.objects.link(made)
    bpy.context.scene.camera = made


def add_lights(scene, arrays):
    nodes = Nodes(bpy.context.scene.world)
    sky = nodes.add('ShaderNodeTexEnvironment', image=image('sky', arrays[scene['sky']]))
    background = nodes.add('ShaderNodeBackground', {'Color': sky.outputs['Color'], 'Strength': 1.0})
    nodes.add('ShaderNodeOutputWorld', {'Surface': background.outputs[0]})
    bpy.context.scene.world.cycles_visibility.glossy = False
    if scene['sun'] is None:
        return
    sun = bpy.data.lights.new('sun', 'SUN')
    sun.energy, sun.color, sun.angle = 1.0, scene['sun']['irradiance'], scene['sun']['width']
    made = bpy.data.objects.new('sun', sun)
    made.matrix_world = Vector(scene['sun']['direction']).to_track_quat('Z', 'Y').to_matrix().to_4x4()
    bpy.context.scene.collection.objects.link(made)


def set_up(scene):
    """The same samples whenever it is drawn, and a screen's colours without a tone of their own."""
    here = bpy.context.scene
    here.render.engine = 'CYCLES'
    cycles = here.cycles
    cycles.device, cycles.seed, cycles.samples = 'CPU', 0, scene['samples']
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.diffuse_bounces = cycles.glossy_bounces = cycles.max_bounces = BOUNCES
    render = here.render
    render.threads_mode, render.threads = 'FIXED', scene['threads']
    render.resolution_x, render.resolution_y = scene['size']
    render.resolution_percentage, render.dither_intensity = 100, 0.0
    render.image_settings.file_format, render.image_settings.color_mode = 'PNG', 'RGB'
    render.filepath = os.path.abspath(scene['picture'])
    here.display_settings.display_device = 'sRGB'
    here.view_settings.view_transform = 'Standard'


def main():
    with open('scene.json', encoding='utf-8') as file:
        scene = json.load(file)
    arrays = np.load('arrays.npz')
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.world = bpy.data.worlds.new('world')
    set_up(scene)
    for number, what in enumerate(scene['objects']):
        add_object(number, what, arrays)
    add_camera(scene['camera'])
    add_lights(scene, arrays)
    bpy.ops.render.render(write_still=True)


main()
