"""Whether the package, its messages and its programs are found, and the Debian packages are there."""
import importlib.util
import re

from checkup import finding

PROGRAMS = ('ask_device', 'cloth_simulation', 'exoskeleton_driver', 'force_renderer', 'proximity')
# Headings of packages.txt whose packages only some need, and for what.
FOR_SOME = {'Tests': 'scripts/test', 'Sanitized builds': 'scripts/test', 'scripts/bench': 'scripts/bench', 'scripts/study': 'scripts/study',
            'View': 'rviz and its pictures', 'HTML pages': 'scripts/doc', 'Pictures of cloth': 'scripts/render'}


def find_package():
    """@returns version and folder of haptex, as ROS finds it, or None"""
    try:
        import rospkg
        folder = rospkg.RosPack().get_path('haptex')
    except Exception:  # no rospkg, no such package, or a manifest that cannot be read
        return None
    manifest = open(f'{folder}/package.xml', encoding='utf-8').read()
    return re.search('<version>(.*?)</version>', manifest).group(1), folder


def has_messages():
    try:
        return importlib.util.find_spec('haptex.msg') is not None
    except ImportError:
        return False


def check_workspace(machine, package, messages):
    """@param package of find_package() @param messages of has_messages()"""
    ok, _, _, error = finding.of('workspace')
    source = 'source build/devel/setup.bash    # after scripts/demo or scripts/test'
    if not package:
        yield error('ROS does not find the package haptex', source)
    else:
        yield ok(f'ROS finds haptex in {package[1]}')
    if not messages:
        yield error('Python does not find the messages of haptex: rosservice and rostopic fail', source)
    missing = [name for name in PROGRAMS if not machine.program(name)]
    if missing:
        yield error(f'not built, or not found by rosrun: {", ".join(missing)}', f'scripts/demo\n{source}')
    else:
        yield ok('the programs are built')


def listed_packages(text):
    """@param text of packages.txt @returns package and heading, in their order"""
    heading, packages, behind_comment = '', [], False
    for line in text.splitlines():
        if line.startswith('#'):
            heading = heading if behind_comment else line.lstrip('# ')
            behind_comment = True
        elif line.strip():
            packages.append((line.split('#')[0].strip(), heading))
            behind_comment = False
        else:
            behind_comment = False
    return packages


def purpose_of(heading):
    """None: everything needs it."""
    return next((purpose for begin, purpose in FOR_SOME.items() if heading.startswith(begin)), None)


def check_packages(machine, folder):
    """@param folder of haptex"""
    ok, note, warning, error = finding.of('packages')
    listed = listed_packages(machine.text(f'{folder}/scripts/packages.txt') or '')
    answer = machine.run('dpkg-query', '-W', '-f=${Package} ${db:Status-Status}\n')
    if not listed or answer.status != 0:
        yield note('which Debian packages are missing is not known: there is no '
                   f'{"dpkg" if listed else "list"}', 'see scripts/packages.txt of the repository')
        return
    there = {line.split()[0] for line in answer.output.splitlines() if line.endswith(' installed')}
    missing = {}
    for package, heading in listed:
        if package not in there:
            missing.setdefault(purpose_of(heading), []).append(package)
    for purpose, packages in missing.items():
        install = f'sudo apt-get install {" ".join(packages)}'
        if purpose is None:
            yield error(f'missing: {", ".join(packages)}', install)
        else:
            yield warning(f'missing, for {purpose} only: {", ".join(packages)}', install)
    if not missing:
        yield ok(f'all {len(listed)} Debian packages are installed')
