"""KES parameters, and the values that stand for the rated properties, from a fabric file. Formulas
and conditions: docs/evaluation.md; Kawabata 1980, The Standardization and Analysis of Hand
Evaluation, 2nd edition."""
import math
import pathlib

import numpy as np
from scipy.integrate import quad
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator, PPoly
from scipy.optimize import brentq

from . import strict_yaml as strict
from .quoted import quoted

GF_PER_CM = 0.980665  # N/m
TENSILE_LOAD = 500 * GF_PER_CM  # N/m
SHEAR_TENSION = 10 * GF_PER_CM  # N/m
LONGEST = 20.0  # engineering strain up to which a load is looked for
GRAVITY = 9.80665  # m/s2

# The 16 parameters of Kawabata's equations and the units that they are in.
UNITS = {'LT': '-', 'WT': 'gf.cm/cm2', 'RT': '%', 'B': 'gf.cm2/cm', '2HB': 'gf.cm/cm',
         'G': 'gf/(cm.deg)', '2HG': 'gf/cm', '2HG5': 'gf/cm', 'LC': '-', 'WC': 'gf.cm/cm2', 'RC': '%',
         'MIU': '-', 'MMD': '-', 'SMD': 'um', 'T': 'mm', 'W': 'mg/cm2'}


def _with_origin(points, odd):
    """Adds the origin, and the mirror image of points of one side where the curve is odd."""
    points = [tuple(map(float, point)) for point in points]
    if all(strain != 0.0 for strain, _ in points):
        points = sorted([*points, (0.0, 0.0)])
    if odd and points[0][0] >= 0.0:
        points = [(-strain, -stress) for strain, stress in reversed(points[1:])] + points
    return points


class Curve:
    """An elastic curve as docs/fabric_files.md defines it: stress (N/m) of Green strain."""

    def __init__(self, value, odd=False):
        if 'modulus' in value:
            knots, stresses = [0.0, 1.0], [0.0, float(value['modulus'])]
            self._inside = CubicHermiteSpline(knots, stresses, [stresses[1]] * 2)
        elif 'polynomials' in value:
            knots = np.array(value['polynomials']['knots'], float)
            rows = np.array(value['polynomials']['coefficients'], float)
            self._inside = PPoly(rows.T[::-1], knots)
        else:
            knots, self._inside = self._through(value, odd)
        self._first, self._last = knots[0], knots[-1]
        self._slope = self._inside.derivative()

    @staticmethod
    def _through(value, odd):
        points = _with_origin(value['points'], odd)
        if value['quantity'] == 'force_per_width_over_engineering_strain':
            points = [(e + 0.5 * e * e, force / (1.0 + e)) for e, force in points]
        strains, stresses = np.array(points).T
        slopes = PchipInterpolator(strains, stresses).derivative()(strains)
        secants = np.diff(stresses) / np.diff(strains)
        slopes[0], slopes[-1] = secants[0], secants[-1]
        return strains, CubicHermiteSpline(strains, stresses, slopes)

    def __call__(self, strain):
        """Beyond its ends the curve goes on straight."""
        inside = min(max(strain, self._first), self._last)
        return float(self._inside(inside) + (strain - inside) * self._slope(inside))


def _force(curve, elongation):
    """Force per rest width (N/m) at an engineering strain."""
    return (1.0 + elongation) * curve(elongation + 0.5 * elongation ** 2)


def _elongation_at(load, force):
    """@throws ValueError if the force does not reach the load"""
    high = 1e-3
    while force(high) < load:
        high *= 2.0
        if high > LONGEST:
            raise ValueError(f'{load:g} N/m are not reached at any strain up to {LONGEST:g}')
    return brentq(lambda e: force(e) - load, 0.0, high, xtol=1e-15, rtol=1e-14)


def _tensile(curve):
    """@returns EMT (a fraction) and the work of pulling to it (J/m2)"""
    strain = _elongation_at(TENSILE_LOAD, lambda e: _force(curve, e))
    # Gauss-Kronrod between many points: the curve is smooth piece by piece.
    parts = np.linspace(0.0, strain, 101)
    return strain, sum(quad(lambda e: _force(curve, e), a, b, epsabs=1e-13, epsrel=1e-12)[0]
                       for a, b in zip(parts, parts[1:]))


def _shear_rigidity(shear, pulled):
    """G (N/m per degree): mean slope from 0.5 to 2.5 degrees while 10 gf/cm pull the threads across."""
    def stress(degrees):
        angle = math.radians(degrees)
        longer = _elongation_at(SHEAR_TENSION, lambda e: math.cos(angle) * _force(pulled, e))
        return shear(math.sin(angle) * (1.0 + longer))
    return 0.25 * (stress(2.5) - stress(0.5) + stress(-0.5) - stress(-2.5))


def _mean(values, keys=('weft', 'warp')):
    return sum(float(values[key]) for key in keys) / len(keys)


def _compression(value):
    """@returns T0, Tm (m) and WC (J/m2), or nothing where the file has another curve"""
    kes = value.get('kes')
    return tuple(float(kes[name]) for name in ('T0', 'Tm', 'WC')) if kes else None


class FabricValues:
    """Of one fabric file. `parameters` are the KES parameters that it has, the mean of weft and warp,
    in UNITS; `properties` the values that stand for the rated properties. What the file does not say
    is in neither."""

    def __init__(self, path):
        """@throws ValueError if the file cannot be read or lacks what every fabric has"""
        self.path = str(path)
        fabric = strict.load(path, ['name', 'areal_density'])
        try:
            self.name = fabric['name']
            self.parameters, self.properties = {}, {}
            self._add_membrane(fabric)
            self._add_bending(fabric)
            self._add_compression(fabric)
            self._add_surface(fabric)
        except (KeyError, TypeError, AttributeError) as error:
            raise ValueError(f'{path}: no fabric file, see docs/fabric_files.md: {error!r}') from error

    def _add_membrane(self, fabric):
        weft, warp = (Curve(fabric[name]['elastic']) for name in ('weft', 'warp'))
        shear = Curve(fabric['shear']['elastic'], odd=True)
        density = float(fabric['areal_density']['value'])
        pulls = [_tensile(curve) for curve in (weft, warp)]
        rigidity = 0.5 * (_shear_rigidity(shear, warp) + _shear_rigidity(shear, weft))
        self.parameters |= {
            'LT': sum(work / (0.5 * TENSILE_LOAD * strain) for strain, work in pulls) / 2,
            'WT': sum(work for _, work in pulls) / 2 / GF_PER_CM,
            'G': rigidity / GF_PER_CM, 'W': density * 100.0}
        if 'resilience' in fabric:
            self.parameters['RT'] = 100.0 * _mean(fabric['resilience'])
        for name in ('2HG', '2HG5'):
            if name in fabric['shear'].get('hysteresis', {}):
                self.parameters[name] = float(fabric['shear']['hysteresis'][name]) / GF_PER_CM
        self.properties |= {
            'tensile_stiffness': sum(TENSILE_LOAD / strain for strain, _ in pulls) / 2,
            'shear_stiffness': math.degrees(rigidity), 'weight': density}

    def _add_bending(self, fabric):
        if 'bending' not in fabric:
            return
        bending = fabric['bending']
        rigidity = _mean(bending)
        self.parameters['B'] = rigidity / 9.80665e-5
        if 'hysteresis' in bending:
            self.parameters['2HB'] = _mean(bending['hysteresis']) / 9.80665e-3
        self.properties['bending_stiffness'] = rigidity
        self.properties['drape'] = (rigidity / (self.properties['weight'] * GRAVITY)) ** (1.0 / 3.0)

    def _add_compression(self, fabric):
        kes = _compression(fabric.get('compression', {}))
        if kes is None:
            return
        thick, thin, work = kes
        self.parameters |= {'LC': work / (0.5 * 50 * 98.0665 * (thick - thin)), 'WC': work / GF_PER_CM,
                            'T': 1e3 * thick}
        self.properties['compressibility'] = (thick - thin) / thick

    def _add_surface(self, fabric):
        if 'friction' in fabric:
            self.parameters['MIU'] = self.properties['friction'] = float(fabric['friction']['value'])
        if 'surface' in fabric:
            kes = fabric['surface']['kes']
            self.parameters |= {'MMD': float(kes['MMD']), 'SMD': 1e6 * float(kes['SMD'])}
            self.properties['roughness'] = float(kes['SMD'])


# Of `properties`, with the formula for tables and plots.
PROPERTY_UNITS = {'tensile_stiffness': 'N/m, 500 gf/cm over EMT', 'shear_stiffness': 'N/m per rad, G',
                  'bending_stiffness': 'N.m, B', 'roughness': 'm, SMD', 'friction': 'MIU',
                  'compressibility': '(T0 - Tm)/T0', 'weight': 'kg/m2, W',
                  'drape': 'm, bending length (B/(W g))^(1/3)'}


def find_fabric(name, config):
    """@param name of a file in config/fabrics, or the path of one @throws ValueError naming it"""
    folder = pathlib.Path(config) / 'fabrics'
    path = strict.path_of(name, folder)
    if not path.is_file():
        names = ', '.join(sorted(file.stem for file in folder.glob('*.yaml')))
        raise ValueError(f'there is no fabric {quoted(name)}: allowed is the path of a file, or a name of '
                         f'{names}')
    return path
