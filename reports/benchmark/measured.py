"""Runs of other programs, with what they cost."""
import os
import resource
import signal
import subprocess


def run(command, timeout):
    """Exit status (negative: a signal, None: timeout), processor seconds, peak resident bytes and standard output of a process."""
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (timeout, timeout + 5)))
    output = child.stdout.read()
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = 0
    code = os.waitstatus_to_exitcode(status)
    if code in (-signal.SIGXCPU, -signal.SIGKILL):
        code = None
    return code, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024, output
