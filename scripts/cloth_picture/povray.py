"""Writes what is seen as a scene of POV-Ray 3.7 and has it drawn. The same scene is the same picture: no
light is jittered, and one thread draws, as what radiosity gathers depends on which of several comes first."""
import os
import pathlib
import shutil
import subprocess
import tempfile

import numpy as np

from bag_report.bags import Refused

from .environment import write_hdr

SUN_WIDTH = 0.04  # of its distance: softens shadows as a thin haze does
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


def normals_of(surface):
    """Of every particle: the mean of its triangles' by area."""
    corners = surface.positions[surface.triangles]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(surface.positions)
    for corner in range(3):
        np.add.at(normals, surface.triangles[:, corner], areas)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(lengths > 0.0, normals / np.maximum(lengths, 1e-30), [0.0, 0.0, 1.0])


def mesh(surface, textures, texture_of):
    """@param textures texts @param texture_of triangles, which of them"""
    normals = normals_of(surface)
    faces = [f'{vector(triangle)},{number}' for triangle, number in zip(surface.triangles, texture_of)]
    return ('mesh2 {\n' + items('vertex_vectors', [vector(row) for row in surface.positions])
            + items('normal_vectors', [vector(row) for row in normals])
            + items('texture_list', textures) + items('face_indices', faces) + '}\n')


def body(surface, look):
    return mesh(surface, [plain_texture(look)], np.zeros(len(surface.triangles), dtype=int))


def matrix_of(rows):
    """@param rows 4 x 3: where the axes x, y and z go, and the origin"""
    return f'matrix <{",".join(f"{value:.8g}" for value in np.ravel(rows))}>'


def shape(kind, sizes, pose, look):
    """@param kind sphere (radius), box (whole edge lengths) or capsule and cylinder (radius, length), in its
    own axes, along z @param pose 4 x 4, from these into the world"""
    if kind == 'box':
        half = 0.5 * np.array(sizes)
        text = f'box {{ {vector(-half)},{vector(half)}'
    elif kind == 'sphere':
        text = f'sphere {{ 0,{sizes[0]:.7g}'
    else:
        radius, end = sizes[0], 0.5 * sizes[1]
        text = f'cylinder {{ <0,0,{-end:.7g}>,<0,0,{end:.7g}>,{radius:.7g}'
        if kind == 'capsule':
            text = (f'union {{ {text} }} sphere {{ <0,0,{-end:.7g}>,{radius:.7g} }} '
                    f'sphere {{ <0,0,{end:.7g}>,{radius:.7g} }}')
    return f'{text} {plain_texture(look)} {matrix_of(pose[:3].T)} }}\n'


def floor(height, look):
    return f'plane {{ z,{height:.7g} {plain_texture(look)} }}\n'


def lights(environment, file_name):
    """All around by radiosity, and the sun."""
    # A map of POV-Ray begins at +x and stands about +y; about z after the turn.
    text = (f'sky_sphere {{ pigment {{ image_map {{ hdr "{file_name}" gamma 1.0 map_type 1 interpolate 2 }} }} '
            'rotate 90*x }\n')
    if environment.sun is not None:
        side = SUN_WIDTH * 1000.0
        text += (f'light_source {{ {vector(1000.0 * environment.sun)}, rgb {vector(environment.sunlight)} '
                 f'parallel point_at 0 area_light {side}*x,{side}*y,{SUN_SIDE},{SUN_SIDE} adaptive 0 circular '
                 'orient }\n')
    return text


def camera_text(camera, size):
    # POV-Ray's axes are left-handed: to the right is -x of its own camera where up is z.
    return (f'camera {{ perspective location {vector(camera.eye)} sky z up z right '
            f'{-size[0] / size[1]:.7g}*x angle {np.degrees(camera.angle):.6g} look_at {vector(camera.target)} }}\n')


def require_povray():
    if shutil.which('povray') is None:
        raise Refused('povray is not installed: apt-get install povray')


def error_in(said):
    """Of all that POV-Ray says, on one line."""
    lines = [line.strip() for line in said.splitlines() if 'error' in line.lower()]
    return '; '.join(lines) or ' '.join(said.split())[-400:]


def without_time(png):
    """The chunks that make the picture, without when and by what it was drawn."""
    kept, place = png[:8], 8
    while place < len(png):
        end = place + 12 + int.from_bytes(png[place:place + 4], 'big')
        if png[place + 4:place + 8] in (b'IHDR', b'gAMA', b'sRGB', b'IDAT', b'IEND'):
            kept += png[place:end]
        place = end
    return kept


def draw(camera, size, environment, objects, files, output):
    """@param size pixels, width and height @param objects texts @param files contents by name, which
    the objects refer to @param output path of a PNG @throws Refused with what POV-Ray says"""
    require_povray()
    with tempfile.TemporaryDirectory(prefix='haptex_render_') as name:
        folder = pathlib.Path(name)
        # POV-Ray's pictures on a sphere turn to the right, as seen from within; azimuth turns to the left.
        write_hdr(environment.radiance[:, ::-1], folder / 'sky.hdr')
        for file_name, content in files.items():
            (folder / file_name).write_bytes(content)
        (folder / 'scene.pov').write_text(HEADER.format() + camera_text(camera, size)
                                          + lights(environment, 'sky.hdr') + ''.join(objects))
        run = subprocess.run(
            ['povray', '+Iscene.pov', '+Opicture.png', f'+W{size[0]}', f'+H{size[1]}', '+FN8', '-D', '-GA',
             '+WT1', '+A0.3', '+AM2', '+R2', '-J', 'File_Gamma=sRGB', '+GF'],
            cwd=folder, capture_output=True, text=True, errors='replace',
            env={**os.environ, 'HOME': name})
        picture = folder / 'picture.png'
        if run.returncode != 0 or not picture.exists():
            raise Refused(f'povray could not draw it: {error_in(run.stderr)}')
        pathlib.Path(output).write_bytes(without_time(picture.read_bytes()))
