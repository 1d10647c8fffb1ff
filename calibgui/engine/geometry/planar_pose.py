"""The pose of a plane from its homography, and the second pose that looks almost alike.

Under known focal lengths the homography M from a plane (mm) to the image, measured from the
principal point, is diag(fx, fy, 1) [r1 r2 T] up to scale. Dividing by the focal lengths gives two
columns of the rotation and the translation in closed form (Zhang 2000, section 3.1); the
rotation closest to them is the answer. It minimises no error in the image and is a start only.

From far away a plane looks alike from two sides: only perspective tells a tilt from its mirror
image (Schweighofer and Pinz 2006). With v the direction to the middle of the points, the plane

    R' = (I - 2 v v^T) R diag(1, 1, -1),     the middle of the points where it was,

has the depths of its points along v reversed and everything across v unchanged. Each of the two
can be a minimum of the reprojection error.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array


def poses_from_homographies(M: Array, f: Array, points: Array) -> tuple[Array, Array]:
    """Return rotations (K, 3, 3) and translations (K, 3) mm under known focal lengths.

    Args:
        M: (K, 3, 3) homographies from the plane, mm, to the undistorted image, px from the
            principal point.
        f: (2,) focal lengths, px.
        points: (K, 2) a point of each plane that lies in front of the camera, mm.
    """
    G = M / np.array([f[0], f[1], 1.0])[:, None]
    G = (
        G
        / np.sqrt(np.linalg.norm(G[:, :, 0], axis=1) * np.linalg.norm(G[:, :, 1], axis=1))[
            :, None, None
        ]
    )
    first = np.concatenate([points, np.ones((len(M), 1))], axis=1)
    depth = np.einsum("ki,ki->k", G[:, 2], first)
    G = G * np.sign(depth)[:, None, None]  # the plane is in front of the camera
    r3 = np.cross(G[:, :, 0], G[:, :, 1])
    # The closest rotation to [r1 r2 r3].
    U, _, Vt = np.linalg.svd(np.concatenate([G[:, :, :2], r3[:, :, None]], axis=2))
    sign = np.linalg.det(U @ Vt)
    U[:, :, 2] *= sign[:, None]
    return U @ Vt, G[:, :, 2]


def mirror_planar_poses(R: Array, T: Array, middle: Array) -> tuple[Array, Array]:
    """Return the poses with the planes' depths reversed along the rays to their middles.

    Args:
        R: (K, 3, 3) rotations.
        T: (K, 3) translations, mm.
        middle: (K, 2 or 3) the middle of each plane's points, mm.
    """
    column = middle[..., None]
    axes = column.shape[1]
    centre = R[..., :axes] @ column + T[..., None]
    v = centre / np.linalg.norm(centre, axis=1, keepdims=True)
    mirrored = (R - 2 * v @ (v.swapaxes(1, 2) @ R)) * np.array([1.0, 1.0, -1.0])
    return mirrored, (centre - mirrored[..., :axes] @ column)[..., 0]
