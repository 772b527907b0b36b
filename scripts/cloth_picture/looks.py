"""What fabrics and other things look like."""
import pathlib

import numpy as np
import roslib.packages
import yaml

from bag_report.bags import Refused

# Linear red, green and blue; gloss and width as the key look of fabric files has them.
UNDYED = (0.46, 0.41, 0.33)  # grey-beige, of fabric files without a look
FILES = 'fabrics', 'laminates'  # below config


class Look:
    def __init__(self, colour, gloss=0.0, width=1.0):
        self.warp = self.weft = np.array(colour, dtype=float)
        self.gloss, self.width = gloss, width


FLOOR = Look((0.52, 0.51, 0.49))
FIGURE = Look((0.60, 0.56, 0.52), 0.02, 0.5)  # a shop's dummy, and obstacles


def shares(data, key):
    values = [float(value) for value in data[key]]
    if len(values) != 3 or not all(0.0 <= value <= 1.0 for value in values):
        raise ValueError(f'look.{key} = {data[key]}: allowed are three shares from 0 to 1')
    return np.array(values)


def look_of(data):
    """Of the contents of a fabric file, whose layers are seen from the first on.
    @throws ValueError naming a key with a value that is not allowed"""
    data = data.get('look')
    if data is None:
        return Look(UNDYED)
    look = Look(UNDYED, float(data['gloss']), float(data['width']))
    if not (0.0 <= look.gloss <= 1.0 and 0.0 < look.width <= 1.0):
        raise ValueError(f'look: gloss {look.gloss} and width {look.width}: allowed are 0 to 1, the width '
                         'greater than 0')
    look.warp, look.weft = shares(data, 'warp'), shares(data, 'weft')
    return look


class Fabric:
    """A fabric as it is seen: its name, the text of its file, where that is, if it is known, its look, and
    whether it says how its yarns lie."""

    def __init__(self, name, text, path=None):
        self.name, self.text, self.path = name, text, path
        try:
            data = yaml.safe_load(text)
            if not isinstance(data, dict):
                raise ValueError('it is no mapping')
            layers = data.get('layers')
            if layers and isinstance(layers[0], dict):
                data = layers[0]
            elif layers and path is not None:
                data = yaml.safe_load((path.parent / layers[0]).read_text(encoding='utf-8'))
            self.look, self.has_surface = look_of(data), 'surface' in data
        except (ValueError, KeyError, TypeError, AttributeError, OSError, yaml.YAMLError) as error:
            raise Refused(f'fabric {name}: its file cannot be read ({error})') from error


UNDYED_FABRIC = Fabric('unknown fabric', '{}')  # of an OBJ file, which does not say


def package_fabrics():
    """Paths of the package's fabric files by name."""
    config = pathlib.Path(roslib.packages.get_pkg_dir('haptex'), 'config')
    return {path.stem: path for folder in FILES for path in sorted((config / folder).glob('*.yaml'))}


def fabric_called(name):
    """@param name of the package's, or a path, which has a slash"""
    if '/' in name:
        path = pathlib.Path(name)
    else:
        known = package_fabrics()
        if name not in known:
            raise Refused(f'there is no fabric {name}; allowed are the path of a fabric file, and '
                          + ', '.join(known))
        path = known[name]
    try:
        return Fabric(path.stem, path.read_text(encoding='utf-8'), path)
    except (OSError, UnicodeDecodeError) as error:
        raise Refused(f'{path}: cannot be read ({error})') from error
