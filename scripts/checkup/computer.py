"""Whether the computer lets the loops be in time, and what it is."""
import platform

from checkup import finding

PRIORITY = 80  # of SCHED_FIFO: realtime::kLoopPriority
PROCESSORS = 2  # the force loop has the last one for itself
STEAL = 0.01  # share of the time that the host may take
LOOK = 1.0  # s, for how long the steal is counted


def limit_line(user, words):
    return (f"echo '{user} - {words}' | sudo tee -a /etc/security/limits.d/haptex.conf\n"
            'log in again')


def check_limits(machine):
    ok, _, warning, _ = finding.of('limits')
    limit = machine.limit('rtprio')
    if machine.fifo_granted(PRIORITY):
        yield ok(f'SCHED_FIFO of priority {PRIORITY} is granted')
    elif limit is None or limit >= PRIORITY:
        yield warning(f'SCHED_FIFO is refused, although rtprio is {limit or "unlimited"}: '
                      'forces are late on a busy machine',
                      'in a container: docker run --cap-add=sys_nice --ulimit rtprio=80')
    else:
        yield warning(f'rtprio is {limit}, {PRIORITY} are needed for SCHED_FIFO: '
                      'forces are late on a busy machine',
                      limit_line(machine.user, f'rtprio {PRIORITY}'))
    locked = machine.limit('memlock')
    if locked is None or machine.is_root:
        yield ok('memory can be locked')
    else:
        yield warning(f'memlock is {locked // 1024} KiB: memory cannot be locked, and what is swapped '
                      'out makes forces late', limit_line(machine.user, 'memlock unlimited'))


def check_processors(machine):
    ok, note, warning, _ = finding.of('processors')
    count = machine.processors()
    if count < PROCESSORS:
        yield warning(f'{count} processor: cloth and forces take it from each other',
                      f'give it {PROCESSORS}, or run the cloth on another computer (docs/nodes.md)')
    else:
        yield ok(f'{count} processors')
    texts = (machine.text(path) for path in
             machine.paths('/sys/devices/system/cpu/cpu[0-9]*/cpufreq/scaling_governor'))
    governors = sorted({text.strip() for text in texts if text})
    if not governors:
        yield ok('the clock of the processors is not this system\'s to choose')
    elif governors == ['performance']:
        yield ok('the governor of the processors is performance')
    else:
        yield warning(f'the governor of the processors is {", ".join(governors)}: they slow down between '
                      'two steps', 'sudo cpupower frequency-set -g performance')
    steal = machine.steal(LOOK)
    if steal > STEAL:
        yield warning(f'the host took {100 * steal:.0f} % of the processors\' time within {LOOK:g} s: '
                      'every loop stalls now and then',
                      'fewer virtual machines on the host, or processors of its own for this one')
    else:
        yield ok(f'the host took {100 * steal:.1f} % of the processors\' time within {LOOK:g} s')


def check_display(machine):
    ok, note, warning, _ = finding.of('display')
    display = machine.environment.get('DISPLAY')
    if not display:
        yield note('DISPLAY is not set: rviz does not open, everything else runs',
                   'scripts/rviz_screenshot makes pictures without a display')
        return
    if machine.run('xdpyinfo').status != 0:
        yield warning(f'the display {display!r} does not answer: rviz does not open',
                      'log in at the screen, or with ssh -X; unset DISPLAY where there is none')
        return
    answer = machine.run('glxinfo', '-B')
    if answer.status is None:
        yield note('whether there is OpenGL is not known: glxinfo is not installed',
                   'sudo apt-get install mesa-utils')
        return
    renderer = next((line.split(':', 1)[1].strip() for line in answer.output.splitlines()
                     if 'OpenGL renderer' in line), '')
    if answer.status != 0 or not renderer:
        yield warning(f'the display {display!r} has no OpenGL: rviz does not open',
                      'export LIBGL_ALWAYS_SOFTWARE=1, or install the graphics driver')
    elif 'llvmpipe' in renderer or 'softpipe' in renderer or 'swrast' in renderer:
        yield note(f'OpenGL is drawn by the processors ({renderer}): rviz takes much of them',
                   'install the graphics driver, or run rviz on another computer')
    else:
        yield ok(f'OpenGL by {renderer}')


def release_of(machine):
    for line in (machine.text('/etc/os-release') or '').splitlines():
        if line.startswith('PRETTY_NAME='):
            return line.split('=', 1)[1].strip('"')
    return 'unknown system'


def check_versions(machine, package):
    """@param package version and folder of haptex, or None"""
    ok, *_ = finding.of('versions')
    words = [release_of(machine), f'Linux {platform.release()}', f'Python {platform.python_version()}']
    roscpp = machine.run('dpkg-query', '-W', '-f=${Version}', 'libroscpp-dev')
    if roscpp.status == 0:
        words.append(f'roscpp {roscpp.output}')
    if package:
        commit = machine.run('git', '-C', package[1], 'describe', '--always', '--dirty')
        words.append(f'haptex {package[0]}' + (f' ({commit.output})' if commit.status == 0 else ''))
    yield ok(', '.join(words))
