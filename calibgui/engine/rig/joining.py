"""Cameras and boards are joined by what they see of each other at the same instants.

A view X = cam_from_board of camera c, board b and an instant i is a chain of three motions,

    X = (cam_from_rig of c) (rig_from_first of i) (first_from_board of b),

in which cameras and boards play the same part: inverted, a board sees the camera. Two cameras are
related by the instants at which both see one board, or two boards whose relation is known; two
boards by the instants at which one camera sees both, or two cameras do whose relation is known.
Either way the relation is what most instants say (``consensus.py``).

Cameras and boards are the nodes of two forests. The pair of nodes that share most instants is
joined first (Kruskal 1956), and what becomes related by it may join others: a camera that sees the
second board only, and the first camera, which sees the first one, once a third camera has seen
both. Cameras that are not joined in the end cannot be calibrated together. Boards need not be: what
is never seen at one instant with the first board has a place of its own at each instant.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.errors import CalibrationError
from calibgui.engine.rig.agreement import count_shared
from calibgui.engine.rig.alone import CameraAlone
from calibgui.engine.rig.consensus import Relation, ViewPoses, find_relation, find_tree
from calibgui.engine.rig.records import RigBoard, RigCamera

_NOWHERE = Relation(np.eye(3), np.zeros(3))


class Sight(NamedTuple):
    """A camera and a board of which it has views."""

    camera: int
    board: int


def list_sights(
    cameras: Sequence[RigCamera], boards: Sequence[RigBoard]
) -> tuple[list[Sight], list[RigCamera]]:
    """List what each camera sees of each board, as cameras that see one board.

    Raises:
        CalibrationError: if no camera sees a board.
    """
    if any(len(camera.views_by_board) > len(boards) for camera in cameras):
        raise ValueError("there are views of more boards than are named")
    for b, board in enumerate(boards):
        if not any(
            camera.views_by_board[b : b + 1] and camera.views_by_board[b] for camera in cameras
        ):
            raise CalibrationError(
                f"No photograph shows {board.name}.",
                "Leave it out, or photograph it together with the others.",
            )
    sights, seen = [], []
    for c, camera in enumerate(cameras):
        found = [b for b, views in enumerate(camera.views_by_board) if views]
        for b in found or [0]:
            name = camera.name if len(boards) == 1 else f"{camera.name}, {boards[b].name}"
            sights.append(Sight(c, b))
            seen.append(replace(camera, name=name, views=camera.views_by_board[b], others=()))
    return sights, seen


class Joined(NamedTuple):
    """Cameras and boards with the places that most instants agree about."""

    cameras: tuple[Relation, ...]
    """The pose of each camera beside the first one, cam_from_rig."""
    boards: tuple[Relation, ...]
    """The pose of each board beside its reference, board_from_reference."""
    references: tuple[int, ...]
    """Number of the board that each one's place is beside; its own number for a reference."""

    def express(self, sights: Sequence[Sight], alone: Sequence[CameraAlone]) -> list[CameraAlone]:
        """Return what cameras see, with the poses of the reference board in place of each."""
        return [
            _express_on(part, self.boards[sight.board])
            for sight, part in zip(sights, alone, strict=True)
        ]


class _Forest:
    """Nodes of one kind, with their relations to the first node of their tree."""

    def __init__(self, count: int) -> None:
        self.roots = list(range(count))
        self.relations = [_NOWHERE] * count
        """Relations node_from_root."""

    def is_joined(self, a: int, b: int) -> bool:
        """Return whether two nodes are in one tree."""
        return self.roots[a] == self.roots[b]

    def join(self, a: int, b: int, relation: Relation) -> None:
        """Join the trees of two nodes by b_from_a; the lower root stays."""
        if self.roots[b] < self.roots[a]:
            a, b, relation = b, a, relation.invert()
        root, moved = self.roots[a], self.roots[b]
        between = self.relations[b].invert().after(relation).after(self.relations[a])
        for node, own in enumerate(self.roots):
            if own == moved:
                self.roots[node] = root
                self.relations[node] = self.relations[node].after(between)


def join_rig(
    cameras: Sequence[RigCamera],
    boards: Sequence[RigBoard],
    sights: Sequence[Sight],
    alone: Sequence[CameraAlone],
    turns: Sequence[Array],
) -> Joined:
    """Find how cameras stand to the first one, and boards to each other.

    Args:
        cameras, boards: the cameras and boards as they are known.
        sights: the cameras and boards that belong together.
        alone: the boards where the views of each of these have them.
        turns: motions of the only board that leave it as it is.

    Raises:
        CalibrationError: if the cameras fall apart into groups; the message names them.
    """
    of_cameras, of_boards = _Forest(len(cameras)), _Forest(len(boards))
    for b, board in enumerate(boards):
        if b and board.pose is not None:
            stated = Relation.of_pose(board.pose)
            of_boards.join(0, b, stated.invert())
    forests = (of_cameras, of_boards)
    while links := _list_links(sights, alone, forests):
        # Most instants first; of equals a camera's, then the first.
        link = max(links, key=lambda link: (link.shared, -link.kind, -link.a, -link.b))
        views = _gather_views(link, sights, alone, forests, turns)
        forests[link.kind].join(link.a, link.b, find_relation(*views))
    if any(of_cameras.roots):
        raise _explain_groups(cameras, boards, sights, of_cameras)
    return Joined(tuple(of_cameras.relations), tuple(of_boards.relations), tuple(of_boards.roots))


class _Link(NamedTuple):
    """Two nodes that are not joined, and what relates them."""

    kind: int
    """Index in `Sight` of what the nodes are: 0 for cameras, 1 for boards."""
    a: int
    b: int
    pairs: list[tuple[int, int]]
    """Numbers of sights of both, of which the other nodes are joined."""
    shared: int
    """Number of instants, of all these pairs, that both sights of a pair share."""


def _list_links(
    sights: Sequence[Sight], alone: Sequence[CameraAlone], forests: Sequence[_Forest]
) -> list[_Link]:
    """List the pairs of nodes that can be joined."""
    shared = count_shared(alone)
    pairs: dict[tuple[int, int, int], list[tuple[int, int]]] = defaultdict(list)
    for s, t in np.argwhere(shared).tolist():
        for kind, (forest, others) in enumerate((forests, forests[::-1])):
            a, b = sights[s][kind], sights[t][kind]
            is_related = others.is_joined(sights[s][1 - kind], sights[t][1 - kind])
            if a < b and is_related and not forest.is_joined(a, b):
                pairs[kind, a, b].append((s, t))
    return [
        _Link(*nodes, found, int(sum(shared[pair] for pair in found)))
        for nodes, found in pairs.items()
    ]


def _gather_views(
    link: _Link,
    sights: Sequence[Sight],
    alone: Sequence[CameraAlone],
    forests: Sequence[_Forest],
    turns: Sequence[Array],
) -> tuple[ViewPoses, list[ViewPoses]]:
    """Gather what `find_relation` takes: the views of both nodes at the instants that they share,
    the second's with the board counted from each end."""
    of_cameras, of_boards = forests
    first: list[ViewPoses] = []
    second: list[list[ViewPoses]] = []
    for s, t in link.pairs:
        _, in_s, in_t = np.intersect1d(
            alone[s].poses.instant, alone[t].poses.instant, return_indices=True
        )
        here, there = alone[s].poses.select(in_s), alone[t].poses.select(in_t)
        if link.kind == 0:
            on_s, on_t = (of_boards.relations[sights[k].board] for k in (s, t))
            first.append(here.express_on(on_s))
            second.append([there.turn(turn).express_on(on_t) for turn in turns])
        else:
            from_s, from_t = (of_cameras.relations[sights[k].camera].invert() for k in (s, t))
            first.append(here.see_from(from_s).invert())
            second.append([there.see_from(from_t).invert()])
    return ViewPoses.concatenate(first), [
        ViewPoses.concatenate(turned) for turned in zip(*second, strict=True)
    ]


def pair_sights(sights: Sequence[Sight], alone: Sequence[CameraAlone]) -> list[tuple[int, int]]:
    """Find pairs of sights that join all of them, those that share most instants first.

    Only where nothing else joins them are two of different cameras and different boards in one:
    what has moved between these may be a camera or a board.
    """
    shared = count_shared(alone)
    cameras, boards = np.array(sights).T
    is_alike = np.equal.outer(cameras, cameras) | np.equal.outer(boards, boards)
    return find_tree(np.where(shared > 0, shared + is_alike * shared.max(), 0))


def _express_on(part: CameraAlone, relation: Relation) -> CameraAlone:
    """Return what a camera sees of a board with the poses of a body at board_from_body."""
    carry = part.poses.carry_to(relation)
    return replace(
        part,
        poses=part.poses.express_on(relation),
        by_focal=(carry @ part.by_focal[..., None])[..., 0],
    )


def _explain_groups(
    cameras: Sequence[RigCamera],
    boards: Sequence[RigBoard],
    sights: Sequence[Sight],
    forest: _Forest,
) -> CalibrationError:
    """Say which cameras see boards together, and which picture would join them."""
    groups = [
        [c for c, root in enumerate(forest.roots) if root == each]
        for each in dict.fromkeys(forest.roots)
    ]
    named = [", ".join(cameras[c].name for c in group) for group in groups]
    first, second = cameras[groups[0][-1]].name, cameras[groups[1][0]].name
    if len(boards) == 1:
        return CalibrationError(
            f"The cameras fall apart into {len(groups)} groups that never see the board together: "
            f"{'; '.join(named)}.",
            f"Take pictures in which {first} and {second} both see the board, or any two cameras "
            "of both groups.",
        )
    seen = [
        ", ".join(boards[b].name for b in sorted({s.board for s in sights if s.camera in group}))
        for group in groups
    ]
    listed = "; ".join(f"{name} (see {what})" for name, what in zip(named, seen, strict=True))
    return CalibrationError(
        f"The cameras fall apart into {len(groups)} groups that nothing joins: {listed}.",
        f"Take pictures in which {first} and {second} both see one board, or in which one camera "
        "sees boards of both groups together; or state how these boards stand to each other.",
    )
