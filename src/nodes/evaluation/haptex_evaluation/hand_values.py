"""Primary hand values and total hand value by coefficients that the user brings; none ship. Form of
the equations: Kawabata 1980, The Standardization and Analysis of Hand Evaluation, 2nd edition.

    HV = C0 + sum_i Ci (xi - mi) / si                                 xi: parameter or its log10
    THV = C0 + sum_k [Ck1 (HVk - Mk1) / Sk1 + Ck2 (HVk^2 - Mk2) / Sk2]
"""
import math
import sys
from typing import NamedTuple

from . import programs
from . import strict_yaml as strict
from .kes_values import UNITS, FabricValues, find_fabric
from .quoted import quoted

USAGE = 'usage: hand_values COEFFICIENTS FABRIC...\n'
LEAST_DEVIATION = 1e-12


class Standard(NamedTuple):
    """How a parameter is standardised: mean and deviation of a population of fabrics."""
    logarithm: bool
    mean: float
    deviation: float


class PrimaryValue(NamedTuple):
    name: str
    constant: float
    coefficients: dict  # by parameter


class TotalTerm(NamedTuple):
    """What a primary hand value adds: linear and quadratic, each standardised by itself."""
    linear: float
    mean: float
    deviation: float
    quadratic: float
    mean_of_squares: float
    deviation_of_squares: float


class HandEquations(NamedTuple):
    source: str
    population: dict  # Standard by parameter
    primary: tuple  # of PrimaryValue
    total_constant: float
    total: dict  # TotalTerm by name of the primary hand value
    assumed: dict  # values of parameters that a fabric lacks

    def values_of(self, parameters):
        """@param parameters KES parameters in kes_values.UNITS
        @returns hand values by name, the total as `THV`, and the names of what was assumed
        @throws ValueError naming the parameters that are missing or not positive under a logarithm"""
        needed = {name for each in self.primary for name in each.coefficients}
        missing = sorted(needed - set(parameters) - set(self.assumed))
        if missing:
            raise ValueError(f'the file does not say {", ".join(missing)}: add them, or state values '
                             'in `assumed` of the coefficients')
        x = {name: self._standardised(name, parameters.get(name, self.assumed.get(name)))
             for name in needed}
        hand = {each.name: each.constant + sum(c * x[name] for name, c in each.coefficients.items())
                for each in self.primary}
        hand['THV'] = self.total_constant + sum(
            term.linear * (hand[name] - term.mean) / term.deviation +
            term.quadratic * (hand[name] ** 2 - term.mean_of_squares) / term.deviation_of_squares
            for name, term in self.total.items())
        return hand, sorted(needed - set(parameters))

    def _standardised(self, name, value):
        standard = self.population[name]
        if standard.logarithm:
            if value <= 0.0:
                raise ValueError(f'{name}: {value:g} must be greater than 0 for its logarithm')
            value = math.log10(value)
        return (value - standard.mean) / standard.deviation


def _numbers(value, where, positive=()):
    return {key: strict.number(number, f'{where}.{key}', LEAST_DEVIATION if key in positive else -math.inf)
            for key, number in value.items()}


def _population(value, where):
    strict.require_keys(value, where, [], UNITS)
    population = {}
    for name, standard in value.items():
        strict.require_keys(standard, f'{where}.{name}', ['logarithm', 'mean', 'deviation'])
        logarithm = strict.one_of(standard.pop('logarithm'), f'{where}.{name}.logarithm', (True, False))
        population[name] = Standard(logarithm, **_numbers(standard, f'{where}.{name}', ['deviation']))
    return population


def _primary(value, where, population):
    if not isinstance(value, list) or not value:
        raise ValueError(f'{where}: {quoted(value)} must be a list of at least 1')
    primary = []
    for i, each in enumerate(value):
        here = f'{where}[{i}]'
        strict.require_keys(each, here, ['name', 'constant', 'coefficients'])
        strict.require_keys(each['coefficients'], f'{here}.coefficients', [], population)
        primary.append(PrimaryValue(strict.text(each['name'], f'{here}.name'),
                                    strict.number(each['constant'], f'{here}.constant'),
                                    _numbers(each['coefficients'], f'{here}.coefficients')))
    strict.texts([each.name for each in primary], where, 1)
    if 'THV' in [each.name for each in primary]:
        raise ValueError(f'{where}: THV is the name of the total hand value')
    return tuple(primary)


def _total(value, where, primary):
    strict.require_keys(value, where, ['constant', 'terms'])
    strict.require_keys(value['terms'], f'{where}.terms', [], [each.name for each in primary])
    terms = {}
    for name, term in value['terms'].items():
        here = f'{where}.terms.{name}'
        strict.require_keys(term, here, TotalTerm._fields)
        terms[name] = TotalTerm(**_numbers(term, here, ['deviation', 'deviation_of_squares']))
    return strict.number(value['constant'], f'{where}.constant'), terms


def read_equations(path):
    """@throws ValueError naming file, key, value and what is allowed"""
    keys = ['source', 'population', 'primary', 'total']
    value = strict.load(path, keys)
    where = str(path)
    strict.require_keys(value, where, keys, ['assumed'])
    assumed = value.get('assumed', {})
    strict.require_keys(assumed, f'{where}: assumed', [], UNITS)
    population = _population(value['population'], f'{where}: population')
    primary = _primary(value['primary'], f'{where}: primary', population)
    constant, total = _total(value['total'], f'{where}: total', primary)
    return HandEquations(strict.text(value['source'], f'{where}: source'), population, primary,
                         constant, total, _numbers(assumed, f'{where}: assumed'))


def print_values(equations, fabrics, out):
    """@param fabrics FabricValues"""
    names = [each.name for each in equations.primary] + ['THV']
    out.write(f'# coefficients: {" ".join(equations.source.split())}\n')
    out.write('\t'.join(['fabric', *names]) + '\n')
    for fabric in fabrics:
        try:
            values, assumed = equations.values_of(fabric.parameters)
        except ValueError as error:
            raise ValueError(f'{fabric.path}: {error}') from error
        out.write('\t'.join([fabric.name, *(f'{values[name]:.4g}' for name in names)]) + '\n')
        for name in assumed:
            out.write(f'# {fabric.name}: {name} = {equations.assumed[name]:g} {UNITS[name]} is assumed\n')


def _print(arguments, config):
    equations = read_equations(arguments[0])
    print_values(equations, [FabricValues(find_fabric(name, config)) for name in arguments[1:]],
                 sys.stdout)


def main(arguments):
    """@returns the exit status"""
    return programs.run('hand_values', USAGE, arguments, _print)
