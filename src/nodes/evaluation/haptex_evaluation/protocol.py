"""The protocol of an evaluation: a YAML file that docs/evaluation.md describes. Times in s."""
import pathlib
from typing import NamedTuple

from . import strict_yaml as strict
from .quoted import quoted

PROPERTIES = ('tensile_stiffness', 'shear_stiffness', 'bending_stiffness', 'roughness', 'friction',
              'compressibility', 'weight', 'drape')
VIRTUAL, REAL = 'virtual', 'real'
LONGEST = 86400.0  # s


class Sample(NamedTuple):
    fabric: str
    kind: str  # VIRTUAL or REAL


class Property(NamedTuple):
    name: str
    instruction: str
    words: tuple  # of the lower and the upper end of the scale
    standards: tuple  # fabrics of the lower and the upper end
    path: str  # of the emulated hand; empty: none
    trial_seconds: float
    standard_seconds: float


class Protocol(NamedTuple):
    title: str
    longest_seconds: float  # what prescribed_seconds() must not exceed
    picture: bool  # whether the person sees the fabric
    scale: tuple  # least and largest rating
    change_seconds: float  # between two fabrics
    samples: tuple  # of Sample
    properties: tuple  # of Property

    def prescribed_seconds(self):
        """The whole session: per property two standards, then every sample, and a change before each."""
        return sum(2 * (self.change_seconds + each.standard_seconds) +
                   len(self.samples) * (self.change_seconds + each.trial_seconds)
                   for each in self.properties)


def _ends(value, where, of):
    strict.require_keys(value, where, ['low', 'high'])
    low, high = (of(value[end], f'{where}.{end}') for end in ('low', 'high'))
    if low == high:
        raise ValueError(f'{where}: low and high are both {quoted(low)}, they must differ')
    return low, high


def _property(value, where, known_fabric, known_path):
    strict.require_keys(value, where, ['name', 'instruction', 'words', 'standards', 'trial_seconds',
                                       'standard_seconds'], ['path'])
    path = value.get('path', '')
    return Property(
        strict.one_of(value['name'], f'{where}.name', PROPERTIES),
        ' '.join(strict.text(value['instruction'], f'{where}.instruction').split()),
        _ends(value['words'], f'{where}.words', strict.text),
        _ends(value['standards'], f'{where}.standards', known_fabric),
        known_path(path, f'{where}.path') if path != '' else '',
        strict.number(value['trial_seconds'], f'{where}.trial_seconds', 1, LONGEST),
        strict.number(value['standard_seconds'], f'{where}.standard_seconds', 1, LONGEST))


def _known(folder):
    """Makes a check of the name of a file in a folder, or of a path."""
    def check(value, where):
        name = strict.text(value, where)
        if not strict.path_of(name, folder).is_file():
            names = sorted(file.stem for file in folder.glob('*.yaml'))
            raise ValueError(f'{where}: there is no {quoted(name)}: allowed is the path of a file, or a name '
                             f'of {", ".join(names)}')
        return name
    return check


def _samples(value, where, known_fabric):
    """Of the keys fabrics and real_fabrics."""
    samples = []
    for key, kind in (('fabrics', VIRTUAL), ('real_fabrics', REAL)):
        if key in value:
            for i, name in enumerate(strict.texts(value[key], f'{where}: {key}', 1)):
                samples.append(Sample(known_fabric(name, f'{where}: {key}[{i}]'), kind))
    if len(samples) < 2:
        raise ValueError(f'{where}: fabrics: {len(samples)} sample, must be at least 2')
    return tuple(samples)


def read_protocol(path, config):
    """@param config the folder with fabrics/ and paths/
    @throws ValueError naming file, key, value and what is allowed"""
    keys = ['title', 'longest_seconds', 'picture', 'scale', 'change_seconds', 'fabrics', 'properties']
    value = strict.load(path, keys)
    where = str(path)
    strict.require_keys(value, where, keys, ['real_fabrics'])
    strict.require_keys(value['scale'], f'{where}: scale', ['least', 'most'])
    least = strict.number(value['scale']['least'], f'{where}: scale.least')
    most = strict.number(value['scale']['most'], f'{where}: scale.most')
    if not least < most:
        raise ValueError(f'{where}: scale.most: {most} must be greater than scale.least, {least}')
    if not isinstance(value['properties'], list) or not value['properties']:
        raise ValueError(f'{where}: properties: {quoted(value["properties"])} must be a list of at least 1')
    known_fabric = _known(pathlib.Path(config) / 'fabrics')
    known_path = _known(pathlib.Path(config) / 'paths')
    properties = tuple(_property(each, f'{where}: properties[{i}]', known_fabric, known_path)
                       for i, each in enumerate(value['properties']))
    strict.texts([each.name for each in properties], f'{where}: properties', 1)
    protocol = Protocol(
        strict.text(value['title'], f'{where}: title'),
        strict.number(value['longest_seconds'], f'{where}: longest_seconds', 1, LONGEST),
        strict.one_of(value['picture'], f'{where}: picture', (True, False)), (least, most),
        strict.number(value['change_seconds'], f'{where}: change_seconds', 0, LONGEST),
        _samples(value, where, known_fabric), properties)
    prescribed = protocol.prescribed_seconds()
    if prescribed > protocol.longest_seconds:
        raise ValueError(f'{where}: the session takes {prescribed:g} s, at most longest_seconds: '
                         f'{protocol.longest_seconds:g} s are allowed')
    return protocol
