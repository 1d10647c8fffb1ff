"""Numbers that the paper prints for Bouguet's 25 images, to set beside ours.

The order of the intrinsics is that of `PAPER_NAMES` (``geometry/frames.py``). The units are the
paper's, px and powers of 1/px.
"""

from __future__ import annotations

TABLE_1 = (
    (-5.2545, -13.4045, 5.8899e-7),
    (-7.1935, -10.5434, 5.9075e-7),
    (-9.2943, -11.1053, 5.8961e-7),
    (-11.7588, -10.0521, 5.9513e-7),
    (-14.8657, -13.0820, 6.0187e-7),
    (-6.7191, 3.7412, 6.0385e-7),
    (-12.7780, 8.5370, 5.8840e-7),
    (-8.1745, 7.3946, 5.7896e-7),
    (-6.6581, -5.9170, 6.0438e-7),
    (0.1254, -5.7894, 5.9086e-7),
    (-4.1062, -3.6927, 5.8336e-7),
    (-5.0844, -2.0198, 5.9013e-7),
    (-6.7979, 0.4586, 5.9456e-7),
    (-10.7166, -0.2313, 6.0155e-7),
    (-7.2134, -0.1467, 5.9825e-7),
    (-17.6458, -8.9736, 6.2405e-7),
    (-8.8328, -0.9312, 6.0560e-7),
    (-10.4511, 0.8707, 6.1284e-7),
    (-7.7047, 8.1823, 5.9927e-7),
    (-11.5716, 8.7465, 5.7727e-7),
    (-15.3545, 9.2107, 5.8167e-7),
    (-16.2622, -2.3090, 5.7556e-7),
    (-6.9279, -0.9114, 5.9850e-7),
    (-9.5771, -2.7039, 6.0412e-7),
    (-6.9795, -14.5303, 5.8064e-7),
)
"""Values of xp, yp, k1 of each view after Stage I."""

TABLE_1_MEAN = (-9.1119, -2.3681)
"""Mean xp, yp over the views, as printed."""

TABLE_2 = (-16.48, -2.90, 5.71e-7, 6.05e-13, -2.06e-18, -6.34e-7, -1.06e-6, 1.37e-6, 656.66, 657.83)
TABLE_2_SD = (0.94, 0.97, 2.85e-8, 6.76e-13, 4.58e-18, 5.23e-7, 7.08e-7, 1.04e-5, 0.71, 0.57)
"""Intrinsics from the real images: values above, standard deviations here."""

TABLE_3 = (-16.48, -2.87, 5.71e-7, 6.11e-13, -2.10e-18, -6.34e-7, -1.07e-6, 1.30e-6, 656.66, 657.82)
TABLE_3_SD = (0.94, 0.97, 2.85e-8, 6.76e-13, 4.58e-18, 5.23e-7, 7.10e-7, 1.03e-5, 0.71, 0.57)
"""Intrinsics from the synthetic images: values above, standard deviations here."""

ASPECT_OF_VIEW_13 = 0.99
"""Pixel aspect ratio from view 13 (figure 4)."""
STAGE_TWO_ITERATIONS = "20 to 25"
"""Number of iterations of Stage II (figure 7)."""
REFERENCE_RESIDUAL = (0.2, 0.1)
"""Mean and standard deviation of e', reference px, real images (figure 11c)."""
IMAGE_SIGMA = (0.091, 0.107)
"""Standard deviations of the approximated reprojection errors, px (eq. 50, figure 12)."""
SYNTHETIC_RESIDUAL = (0.01, 0.005)
"""Mean and standard deviation of e', reference px, synthetic images (figure 16c)."""
EXTRINSIC_ERROR = (0.003, 0.0005)
"""Largest relative error of the extrinsics, and the bound that most stay below (figure 14)."""

BOUGUET = {"xp": (-17.03, 0.58), "yp": (-2.50, 0.55), "fx": (657.25, 0.28), "fy": (657.68, 0.29)}
"""Bouguet's principal point and focal lengths with what section 5.1 calls their SDs, px: three
standard deviations, as his toolbox prints them."""
BOUGUET_SHIFT = {"xp": 0.5, "yp": -0.5}
"""What takes his principal point from the origin at u = W/2, v = H/2, from which the paper gives
it, to the centre of the array, px."""
BOUGUET_SIGMA = (0.119, 0.116)
"""Standard deviations of his reprojection errors x, y, px."""
SHOWN_VIEW = 13
"""Number of the view in figures 4, 6, 9 and 13, counted from 1."""
