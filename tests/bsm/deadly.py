"""Work that ends its process: a module that imports little, since every process of a test imports it again."""

import os
import signal
from pathlib import Path

from bsm.files.output import open_output


def deadly(task, console):
    """Kill this process, always or once; or be at fault."""
    mark = Path(task.output).with_suffix(".mark")
    with open_output(task.output, overwrite=task.may_replace(task.output)) as file:
        file.write(b"begun")
        if "always" in task.input or ("once" in task.input and not mark.exists()):
            mark.touch()
            os.kill(os.getpid(), signal.SIGKILL)
    if "fault" in task.input:
        raise KeyError("a fault of ours")
    return {"input": task.input, "output": task.output}
