"""The pictures of `blender -b -a` of the saved file are those of the add-on's own run."""

import os
import sys

sys.path.insert(0, os.environ["MENISCUS_CHECKS"])
from checks import check, end, path, pixels, same  # noqa: E402

for frame in (1, 2, 3):
    name = f"water_{frame:04d}.png"
    check(f"frame {frame}", same(pixels(path("again", name)), pixels(path("pictures", name))))
end()
