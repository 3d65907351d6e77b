"""Maps for plotter drawings: vpype read drawing.svg pathwarp maps.py:breeze write out.svg"""

import numpy as np


def breeze(x, y):
    """Rows in a breeze that grows towards the right. Units are px, y down."""
    return x + 9 * np.sin(y / 40), y + x / 16 * np.sin(x / 60 + y / 200)
