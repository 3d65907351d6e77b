"""Maps for plotter drawings: vpype read drawing.svg pathwarp maps.py:breeze write out.svg"""

import numpy as np


def breeze(x, y):
    """Rows that drift apart towards the right. Units are px, y down."""
    return x + 9 * np.sin(y / 30), y + x / 15 * np.sin(x / 50 + y / 90)
