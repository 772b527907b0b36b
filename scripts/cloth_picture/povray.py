"""Writes what is seen as a scene of POV-Ray 3.7 and has it drawn. The same scene is the same picture: no
light is jittered, and one thread draws, as what radiosity gathers depends on which of several comes first."""
import os
import pathlib
import tempfile

import numpy as np

from . import programs
from .environment import SUN_WIDTH, write_hdr
from .looks import Look
from .weave import Cloth

SHINING_SHARE = 0.5  # of the sun's light, on what shows how much reaches it: white would be cut off
SHINING = (f'texture {{ pigment {{ rgb <{SHINING_SHARE},0,1> }} '
           'finish { ambient 0 diffuse 1 emission rgb <0,0,1> } }')
SUN_SIDE = 4  # lights along a side of the sun, where a shadow's edge asks for all

HEADER = '''#version 3.7;
global_settings {{
  assumed_gamma 1.0
  max_trace_level 6
  radiosity {{
    pretrace_start 0.08 pretrace_end 0.02 count 100 nearest_count 5 error_bound 0.45 recursion_limit 2
    low_error_factor 0.6 gray_threshold 0 minimum_reuse 0.012 brightness 1 normal off
  }}
}}
#default {{ finish {{ ambient 0 diffuse 1 }} }}
'''


def vector(values):
    return '<' + ','.join(f'{value:.7g}' for value in values) + '>'


def items(name, rows):
    return f'{name} {{ {len(rows)},\n' + ',\n'.join(rows) + ' }\n'


def finish_of(look):
    """Diffuse and highlight; POV-Ray's roughness is the inverse of Blinn's exponent, 2 / width^2 - 2 of
    the slopes that Beckmann's distribution of that width has."""
    roughness = 1.0 / max(1.0, 2.0 / look.width ** 2 - 2.0)
    # As much light as a highlight of that exponent reflects to all sides: POV-Ray's is its largest value.
    height = look.gloss * (1.0 / roughness + 2.0) / 8.0
    return f'finish {{ diffuse {1.0 - look.gloss:.4f} specular {height:.4f} roughness {roughness:.5f} }}'


def plain_texture(look):
    return f'texture {{ pigment {{ rgb {vector(look.warp)} }} {finish_of(look)} }}'


def mesh(surface, textures, texture_of):
    """@param textures texts @param texture_of triangles, which of them"""
    faces = [f'{vector(triangle)},{number}' for triangle, number in zip(surface.triangles, texture_of)]
    return ('mesh2 {\n' + items('vertex_vectors', [vector(row) for row in surface.positions])
            + items('normal_vectors', [vector(row) for row in surface.normals()])
            + items('texture_list', textures) + items('face_indices', faces) + '}\n')


def matrix_of(rows):
    """@param rows 4 x 3: where the axes x, y and z go, and the origin"""
    return f'matrix <{",".join(f"{value:.8g}" for value in np.ravel(rows))}>'


def netpbm(samples):
    """A picture of 16 bits without gamma. @param samples 0 to 1, with or without colours"""
    kind = b'P6' if samples.ndim == 3 else b'P5'
    return kind + b'\n%d %d\n65535\n' % samples.shape[1::-1] + np.round(65535.0 * samples).astype('>u2').tobytes()


def weave_files(weave, name):
    """Pictures by the names that weave_declaration() uses."""
    heights = weave.relief.heights
    lifted = (heights - heights.min()) / max(np.ptp(heights), 1e-12)
    return {f'{name}.pgm': netpbm(lifted), f'{name}.ppm': netpbm(weave.colours())}


def weave_declaration(weave, name):
    """A texture in whose plane z = 0 the piece is the unit square. A step of the picture is 1 / samples there, a
    unit along z the geometric mean of the piece's sides: weave_textures()."""
    relief = weave.relief
    bump = np.ptp(relief.heights) * len(relief.heights) / np.sqrt(relief.size.prod())
    return (f'#declare {name} = texture {{ pigment {{ image_map {{ ppm "{name}.ppm" gamma 1.0 interpolate 2 }} }} '
            f'normal {{ bump_map {{ pgm "{name}.pgm" gamma 1.0 interpolate 2 bump_size {bump:.6g} }} }} '
            f'{finish_of(weave.look)} }}\n')


def weave_textures(cloth, number, name):
    """Of every triangle of the weave: the declared texture where its rest coordinates are."""
    mine = cloth.weave_of == number
    axes, size = cloth.axes(mine), cloth.weaves[number].relief.size
    origins = cloth.surface.positions[cloth.surface.triangles[mine, 0]] \
        - np.einsum('tr,trx->tx', cloth.surface.rest[mine, 0], axes)
    # POV-Ray's bumps are right as seen from the negative side of z, from where its pictures are not mirrored.
    normals = np.cross(axes[:, 1], axes[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    rows = np.stack([size[0] * axes[:, 0], size[1] * axes[:, 1], np.sqrt(size.prod()) * normals, origins], axis=1)
    return [f'texture {{ {name} {matrix_of(row)} }}' for row in rows]


def cloth_text(cloth):
    """@returns text, and contents by name of the files that it refers to"""
    surface, text, files = cloth.surface, '', {}
    texture_of, textures = np.empty(len(surface.triangles), dtype=int), []
    for number, weave in enumerate(cloth.weaves):
        mine = np.flatnonzero(cloth.weave_of == number)
        if not cloth.has_yarns(number):
            texture_of[mine] = len(textures)
            textures.append(plain_texture(weave.even))
            continue
        name = f'Fabric_{number}'
        text += weave_declaration(weave, name)
        files.update(weave_files(weave, name))
        texture_of[mine] = len(textures) + np.arange(len(mine))
        textures += weave_textures(cloth, number, name)
    return text + mesh(surface, textures, texture_of), files


def solid_text(solid, texture=None):
    sizes, texture = solid.sizes, texture or plain_texture(solid.look)
    if solid.surface is not None:
        return mesh(solid.surface, [texture], np.zeros(len(solid.surface.triangles), dtype=int))
    if solid.kind == 'plane':
        return f'plane {{ z,{solid.pose[2, 3]:.7g} {texture} }}\n'
    if solid.kind == 'box':
        half = 0.5 * np.array(sizes)
        text = f'box {{ {vector(-half)},{vector(half)}'
    elif solid.kind == 'sphere':
        text = f'sphere {{ 0,{sizes[0]:.7g}'
    else:
        radius, end = sizes[0], 0.5 * sizes[1]
        text = f'cylinder {{ <0,0,{-end:.7g}>,<0,0,{end:.7g}>,{radius:.7g}'
        if solid.kind == 'capsule':
            text = (f'union {{ {text} }} sphere {{ <0,0,{-end:.7g}>,{radius:.7g} }} '
                    f'sphere {{ <0,0,{end:.7g}>,{radius:.7g} }}')
    return f'{text} {texture} {matrix_of(solid.pose[:3].T)} }}\n'


def sky_text(file_name):
    """All around, by radiosity."""
    # A map of POV-Ray begins at +x and stands about +y; about z after the turn.
    return (f'sky_sphere {{ pigment {{ image_map {{ hdr "{file_name}" gamma 1.0 map_type 1 interpolate 2 }} }} '
            'rotate 90*x }\n')


def sun_text(sun, light):
    side = SUN_WIDTH * 1000.0
    return (f'light_source {{ {vector(1000.0 * np.asarray(sun))}, rgb {vector(light)} '
            f'parallel point_at 0 area_light {side}*x,{side}*y,{SUN_SIDE},{SUN_SIDE} adaptive 0 circular '
            'orient }\n')


def camera_text(camera, size):
    # POV-Ray's axes are left-handed: to the right is -x of its own camera where up is z.
    return (f'camera {{ perspective location {vector(camera.eye)} sky z up z right '
            f'{-size[0] / size[1]:.7g}*x angle {np.degrees(camera.angle):.6g} look_at {vector(camera.target)} }}\n')


def require():
    programs.require('povray')


def at_once():
    """Pictures of a film that are drawn at a time: each is drawn by one thread."""
    return len(os.sched_getaffinity(0))


def options(size, more):
    return ['povray', '+Iscene.pov', f'+W{size[0]}', f'+H{size[1]}', '-D', '-GA', '+WT1', '+A0.3', '+AM2', '+R2', '-J',
            '+GF', *more]


def shining_text(cloth):
    """As cloth_text(): blue by itself, and red in the red light of the sun."""
    return mesh(cloth.surface, [SHINING], np.zeros(len(cloth.surface.triangles), dtype=int)), {}


def write_scene(folder, text, things, text_of_cloth=cloth_text, texture=None):
    """@param texture of all Solids, if not that of their own looks"""
    for thing in things:
        if isinstance(thing, Cloth):
            cloth, files = text_of_cloth(thing)
            text += cloth
            for file_name, content in files.items():
                (folder / file_name).write_bytes(content)
        else:
            text += solid_text(thing, texture)
    (folder / 'scene.pov').write_text(text)


def write_lit(folder, camera, size, environment, things):
    # POV-Ray's pictures on a sphere turn to the right, as seen from within; azimuth turns to the left.
    write_hdr(environment.radiance[:, ::-1], folder / 'sky.hdr')
    text = HEADER.format() + camera_text(camera, size) + sky_text('sky.hdr')
    if environment.sun is not None:
        text += sun_text(environment.sun, environment.sunlight)
    write_scene(folder, text, things)


def draw(camera, size, environment, things, output):
    """@param size pixels, width and height @param things a Cloth, or several, and Solids
    @param output path of a PNG @throws Refused with what POV-Ray says"""
    require()
    with tempfile.TemporaryDirectory(prefix='haptex_render_') as name:
        folder = pathlib.Path(name)
        write_lit(folder, camera, size, environment, things)
        programs.draw(options(size, ['+FN8', 'File_Gamma=sRGB', f'+O{programs.PICTURE}']), folder, output)


def linear(folder, size):
    """(row, column, 3): what POV-Ray draws of the scene in the folder, up to 1."""
    path = folder / 'picture.ppm'
    programs.run(options(size, ['+FP16', 'File_Gamma=1.0', f'+O{path.name}']), folder, path)
    data = path.read_bytes()
    return np.frombuffer(data, '>u2', 3 * size[0] * size[1], len(data) - 6 * size[0] * size[1]).reshape(
        size[1], size[0], 3) / 65535.0


def draw_light(camera, size, environment, things):
    """@returns linear pictures, of matt cloth: (row, column, 3) of all; (row, column) of what reaches the cloth of a sun that shows as 1 on
      a white surface that faces it; and (row, column) shares of the pixels that are cloth"""
    require()
    plain = [thing.matt() if isinstance(thing, Cloth) else thing for thing in things]
    with tempfile.TemporaryDirectory(prefix='haptex_render_') as name:
        folder = pathlib.Path(name)
        write_lit(folder, camera, size, environment, plain)
        lit = linear(folder, size)
        text = '#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n' + camera_text(camera, size)
        if environment.sun is not None:
            text += sun_text(environment.sun, (1.0, 0.0, 0.0))
        write_scene(folder, text, plain, shining_text, plain_texture(Look((0.0, 0.0, 0.0))))
        red, _, blue = np.moveaxis(linear(folder, size), 2, 0)
    return lit, red / SHINING_SHARE, blue
