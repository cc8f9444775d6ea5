"""A throw-away Slurm cluster on this machine: two nodes on the loopback address, gone when the test ends."""

import os
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

CONFIG = Path("/etc/slurm/slurm.conf")
PROGRAMS = ("slurmctld", "slurmd", "munged", "sbatch", "squeue", "scontrol", "scancel")
PATIENCE = 30.0
TEMPLATE = """\
ClusterName=throwaway
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CryptoType=crypto/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherParams=OverMemoryKill
AccountingStorageType=accounting_storage/none
MinJobAge=300
ReturnToService=2
SlurmdParameters=config_overrides
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool.%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.%n.log
SlurmctldTimeout=30
SlurmdTimeout=30
KillWait=2
{nodes}
PartitionName=main Nodes=ALL Default=YES MaxTime=60 State=UP
"""


def missing() -> str:
    """Why no cluster can be started here, empty if one can."""
    absent = [name for name in PROGRAMS if shutil.which(name) is None]
    if os.geteuid() != 0:
        return "a throw-away Slurm needs root"
    if absent:
        return f"Slurm is not installed: {', '.join(absent)} not found (apt-get install slurm-wlm munge)"
    if CONFIG.exists():
        return f"{CONFIG} exists: this machine has a Slurm of its own"
    return ""


@contextmanager
def cluster(folder: Path, nodes: int = 2, cores: int = 1, memory_mb: int = 4000) -> Iterator[None]:
    """Run a cluster of `nodes` with `cores` each until the block ends; all its processes end with it."""
    folder.mkdir(parents=True)
    (folder / "state").mkdir()
    ports = _free_ports(nodes + 1)
    lines = [
        f"NodeName=n{i} NodeHostname={socket.gethostname()} NodeAddr=127.0.0.1 Port={ports[i + 1]} "
        f"CPUs={cores} RealMemory={memory_mb} State=UNKNOWN"
        for i in range(nodes)
    ]
    CONFIG.parent.mkdir(parents=True, exist_ok=True)
    with open(CONFIG, "x") as stream:
        stream.write(
            TEMPLATE.format(host=socket.gethostname(), port=ports[0], folder=folder, nodes="\n".join(lines))
        )
    running: list[subprocess.Popen[bytes]] = []
    try:
        running.append(_munge(folder))
        running.append(_start("slurmctld", "-D"))
        for i in range(nodes):
            running.append(_start("slurmd", "-D", "-N", f"n{i}"))
        _until_idle(nodes)
        yield
    finally:
        subprocess.run(["scancel", "--user", "root"], check=False, capture_output=True, timeout=PATIENCE)
        for process in reversed(running):
            process.terminate()
        for process in running:
            try:
                process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                process.kill()
        CONFIG.unlink()


def _munge(folder: Path) -> subprocess.Popen[bytes]:
    key = folder / "munge.key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o400)
    process = _start(
        *("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={folder}/munge.socket"),
        *(f"--pid-file={folder}/munged.pid", f"--log-file={folder}/munged.log"),
        f"--seed-file={folder}/munged.seed",
    )
    end = time.monotonic() + PATIENCE
    while not (folder / "munge.socket").exists() and time.monotonic() < end:
        time.sleep(0.05)
    return process


def _start(*command: str) -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    )


def _until_idle(nodes: int) -> None:
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        message = subprocess.run(
            ["sinfo", "-h", "-N", "-o", "%T"], capture_output=True, text=True, check=False
        )
        if message.stdout.split().count("idle") == nodes:
            return
        time.sleep(0.2)
    raise RuntimeError(f"the throw-away Slurm did not come up: {message.stdout}{message.stderr}")


def _free_ports(count: int) -> list[int]:
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports
