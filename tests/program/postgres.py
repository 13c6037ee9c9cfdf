# SPDX-License-Identifier: Apache-2.0
"""A PostgreSQL server of a test's own: on a socket and a port of 127.0.0.1, in a temporary folder, gone afterwards."""
import contextlib
import glob
import os
import pathlib
import shutil
import socket
import subprocess
import tempfile

BIN = max(glob.glob("/usr/lib/postgresql/*/bin"), default="")
OTHER = ["runuser", "-u", "postgres", "--"] if os.geteuid() == 0 else []  # it refuses to run as root


class Server:
    def __init__(self, folder):
        self.folder = folder
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        (folder / "password").write_text("secret\n")
        if OTHER:
            for path in (folder, folder / "password"):
                shutil.chown(path, "postgres")
        self.run("initdb", "-D", "data", "-U", "owner", "-A", "scram-sha-256", "--pwfile", "password", "--no-sync", "-E", "UTF8", "--locale", "C")
        self.start()

    def run(self, program, *arguments):
        return subprocess.run([*OTHER, f"{BIN}/{program}", *arguments], cwd=self.folder, check=True, stdout=subprocess.DEVNULL, timeout=120)

    def start(self):
        self.run("pg_ctl", "-D", "data", "-w", "-l", "log", "-o", f"-p {self.port} -c listen_addresses=127.0.0.1 -k {self.folder} -c fsync=off", "start")

    def stop(self, mode="fast"):
        self.run("pg_ctl", "-D", "data", "-w", "-m", mode, "stop")

    def url(self, user="owner", password="secret", database="postgres"):
        return f"postgresql://{user}:{password}@127.0.0.1:{self.port}/{database}"


@contextlib.contextmanager
def server():
    folder = pathlib.Path(tempfile.mkdtemp(prefix="prehend_postgres_"))
    one = Server(folder)
    try:
        yield one
    finally:
        with contextlib.suppress(subprocess.CalledProcessError):
            one.stop("immediate")
        shutil.rmtree(folder, ignore_errors=True)
