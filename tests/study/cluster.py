# SPDX-License-Identifier: GPL-2.0-or-later
"""A Slurm cluster of this machine alone, on the loopback address: munged, slurmctld and slurmd in a
folder of their own."""

import contextlib
import getpass
import glob
import os
import shutil
import signal
import socket
import subprocess
import tempfile
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel")
SBIN = ":/usr/sbin:/sbin"

CONFIGURATION = """
ClusterName=tests
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
SlurmctldPort={controller}
SlurmdPort={node}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
MaxArraySize={tasks}
JobRequeue=1
ReturnToService=2
KillWait=2
MailProg=/bin/true
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=walls Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def missing():
    """The programs that are not installed."""
    path = os.environ["PATH"] + SBIN
    return [name for name in PROGRAMS if not shutil.which(name, path=path)]


def _freePorts(count):
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for s in sockets:
            s.bind(("127.0.0.1", 0))
        return [s.getsockname()[1] for s in sockets]


def _until(found, seconds, what):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if found():
            return
        time.sleep(0.1)
    raise TimeoutError(what)


@contextlib.contextmanager
def cluster(tasks=1001):
    """Start one. Gives the environment in which Slurm's programs find it; ends what it started.

    :param tasks: the largest number of a task in an array is one less
    """
    place = tempfile.TemporaryDirectory(prefix="slurm")
    with place as folder, contextlib.ExitStack() as stack:
        for name in ("state", "spool"):
            os.mkdir(os.path.join(folder, name))
        key = os.path.join(folder, "munge.key")
        with open(os.open(key, os.O_WRONLY | os.O_CREAT, 0o400), "wb") as f:
            f.write(os.urandom(128))
        controller, node = _freePorts(2)
        path = os.path.join(folder, "slurm.conf")
        host = socket.gethostname().split(".")[0]
        with open(path, "w") as f:
            user = getpass.getuser()
            f.write(CONFIGURATION.format(**locals()))
        env = {**os.environ, "SLURM_CONF": path, "PATH": os.environ["PATH"] + SBIN}
        log = stack.enter_context(open(os.path.join(folder, "log"), "ab"))

        def start(*words):
            pipes = dict(stdin=subprocess.DEVNULL, stdout=log, stderr=log)
            process = subprocess.Popen(words, env=env, **pipes)
            stack.callback(_end, process)

        def asked(*words):
            done = subprocess.run(words, env=env, capture_output=True, text=True)
            return done.stdout if done.returncode == 0 else ""

        kinds = "socket pid-file log-file seed-file".split()
        files = [f"--{k}={folder}/munge.{k.removesuffix('-file')}" for k in kinds]
        start("munged", "--foreground", "--force", f"--key-file={key}", *files)
        try:
            _until(lambda: os.path.exists(f"{folder}/munge.socket"), 20, "munged")
            start("slurmctld", "-D", "-f", path)
            start("slurmd", "-D", "-f", path, "-N", host)
            idle = lambda: "idle" in asked("sinfo", "--noheader", "-o", "%t")
            _until(idle, 30, "slurmd")
        except TimeoutError as error:
            logs = glob.glob(os.path.join(folder, "*log"))
            said = [open(path, errors="replace").read()[-2000:] for path in logs]
            raise TimeoutError(f"{error} did not start:\n{''.join(said)}") from None
        yield env
        asked("scancel", "--user", getpass.getuser())
        with contextlib.suppress(TimeoutError):
            _until(lambda: not asked("squeue", "--noheader"), 10, "jobs")


def _end(process):
    process.send_signal(signal.SIGTERM)
    try:
        process.wait(10)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
