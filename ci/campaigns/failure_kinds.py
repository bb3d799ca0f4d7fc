"""What failures of meshers have in common with others of their kind."""
import os
import re

NUMBER = re.compile(r"-?\d+(\.\d+)?(e[-+]?\d+)?")


def kind_of(name, disposition, reason):
    """Disposition and last words, without numbers and without the name of the model; of a wrong result the oracle's name."""
    if disposition in ("timeout", "out-of-memory"):
        return disposition
    reason = reason.replace(name, "MODEL").replace(os.path.basename(name), "MODEL")
    oracle = re.match(r"verify: (\w+: [\w -]+):", reason)
    return "%s: %s" % (disposition, oracle.group(1) if oracle else NUMBER.sub("#", reason))
