#!/usr/bin/env python3
"""Runs fuzz targets side by side for a given CPU time, in slices, and counts the CPU time they had.

    campaign.py BUILD/tests/fuzz STATE --slots segment_shapes segment_threads read_ply,read_obj,read_stl,read_off,read_any

Each slot is one process at a time: its targets by turns, a slice each. STATE keeps corpora, logs, findings and
totals.json over calls; the programs are copied there before each slice, so the build may go on. All runs at the lowest
priority. PIDs stand in STATE/pids, this process first: SIGSTOP to all of them makes the machine quiet, SIGCONT goes on
(units count their own CPU time, nothing the wall's). Ends on SIGTERM, or after --seconds of CPU time in all.
"""

import argparse
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
TICK = os.sysconf("SC_CLK_TCK")


def cpu_seconds(pid):
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return None
    return (int(fields[11]) + int(fields[12])) / TICK


class Slot:
    """One process at a time: the slot's targets by turns."""

    def __init__(self, targets, args, totals):
        self.targets, self.args, self.totals = targets, args, totals
        # Goes on with the target that had least.
        self.process = None

    def start(self):
        self.target = min(self.targets, key=lambda t: self.totals.get(t, {}).get("cpu_s", 0))
        state = self.args.state
        corpus, found = state / "corpus" / self.target, state / "findings"
        for folder in (corpus, found, state / "log", state / "bin"):
            folder.mkdir(parents=True, exist_ok=True)
        program = state / "bin" / f"fuzz_{self.target}"
        shutil.copy2(self.args.programs / f"fuzz_{self.target}", program)
        command = [program, corpus, f"-artifact_prefix={found}/{self.target}-", "-timeout=0", "-report_slow_units=1000000",
                   "-print_final_stats=1"]
        if self.target.startswith("read"):
            command += ["-max_len=4096", f"-dict={HERE / 'formats.dict'}"]
        else:
            command += ["-max_len=600"]
        self.log = (state / "log" / f"{self.target}.log").open("ab")
        self.begin = self.log.tell()
        self.process = subprocess.Popen(command, stdout=self.log, stderr=self.log, cwd=state)
        self.asked = False

    def poll(self):
        """Asks the process to end when its slice is over; accounts for it when it has."""
        pid = self.process.pid
        used = cpu_seconds(pid)
        if not self.asked and used is not None and used > self.args.slice:
            self.process.send_signal(signal.SIGINT)
            self.asked = True
        ended, status, usage = os.wait4(pid, os.WNOHANG)
        if ended:
            self.process.returncode = os.waitstatus_to_exitcode(status)
            self.account(usage)
            self.process = None

    def account(self, usage):
        self.log.close()
        with Path(self.log.name).open("rb") as file:
            file.seek(self.begin)
            text = file.read().decode(errors="replace")
        units = [int(n) for n in re.findall(r"^(?:stat::number_of_executed_units: |#)(\d+)", text, re.M)]
        coverage = re.findall(r" cov: (\d+)", text)
        total = self.totals.setdefault(self.target, {"cpu_s": 0, "units": 0, "slices": 0, "crashes": 0})
        total["cpu_s"] += usage.ru_utime + usage.ru_stime
        total["units"] += max(units, default=0)
        total["slices"] += 1
        total["edges"] = max(total.get("edges", 0), int(coverage[-1]) if coverage else 0)
        # Asked to end, libFuzzer exits with 72.
        total["crashes"] += self.process.returncode not in (0, 72)


def lower_priority():
    os.setsid() if os.getpid() != os.getsid(0) else None
    os.nice(19)
    try:
        Path("/proc/self/autogroup").write_text("19")  # where sessions, not processes, share the cores
    except OSError:
        pass


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=Path)
    parser.add_argument("state", type=Path)
    parser.add_argument("--slots", nargs="+", required=True, help="targets of each slot, with commas between")
    parser.add_argument("--slice", type=float, default=120, help="CPU seconds of a turn (120)")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="CPU seconds in all")
    args = parser.parse_args()
    args.state = args.state.resolve()
    lower_priority()
    if not (args.state / "corpus").exists():
        subprocess.run([sys.executable, HERE / "seeds.py", args.state / "corpus"], check=True)
    totals_file = args.state / "totals.json"
    totals = json.loads(totals_file.read_text()) if totals_file.exists() else {}
    had = sum(t["cpu_s"] for t in totals.values())
    slots = [Slot(s.split(","), args, totals) for s in args.slots]
    ending = []
    signal.signal(signal.SIGTERM, lambda *_: ending.append(True))
    while True:
        over = ending or sum(t["cpu_s"] for t in totals.values()) - had > args.seconds
        for slot in slots:
            if slot.process is None and not over:
                slot.start()
            elif slot.process is not None:
                if over and not slot.asked:
                    slot.process.send_signal(signal.SIGINT)
                    slot.asked = True
                slot.poll()
        running = [s.process.pid for s in slots if s.process is not None]
        (args.state / "pids").write_text("".join(f"{p}\n" for p in [os.getpid(), *running]))
        totals_file.write_text(json.dumps(totals, indent=1) + "\n")
        if over and not running:
            break
        time.sleep(1)


if __name__ == "__main__":
    main()
