# SPDX-License-Identifier: MIT
"""A drained triaxial test with a picture: drained_test.py [PICTURE.png]"""

import sys

import mud

sand = mud.Material("toyoura")
shear = mud.Stage("drained", eps_a_end=0.25, increment=1e-3)
test = mud.element_test(sand, shear, p_eff=100.0, void_ratio=0.831)
print(f"q {test['q'].max():.1f} kPa at the peak, {test['q'][-1]:.1f} kPa at 25 %; e {test['e'][-1]:.3f}")
mud.plot_test(test, sys.argv[1] if len(sys.argv) > 1 else "drained_test.png")
