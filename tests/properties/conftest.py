"""How hard properties are tried: a few examples that are always the same; with `BOUCLE_EXAMPLES=N`, N at random."""

import os
import sys
import types
from pathlib import Path

from hypothesis import HealthCheck, settings

ADDON = Path(__file__).resolve().parents[2] / "addon"

package = types.ModuleType("boucle_addon")
package.__path__ = [str(ADDON)]
sys.modules.setdefault("boucle_addon", package)

NOT_ASKED = {"deadline": None, "suppress_health_check": list(HealthCheck)}
EXAMPLES = os.environ.get("BOUCLE_EXAMPLES")
settings.register_profile(
    "usual", max_examples=60, derandomize=True, database=None, print_blob=True, **NOT_ASKED
)
settings.register_profile(
    "long", max_examples=int(EXAMPLES or 1), database=None, print_blob=True, **NOT_ASKED
)
settings.load_profile("long" if EXAMPLES else "usual")
