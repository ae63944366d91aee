# SPDX-License-Identifier: Apache-2.0
"""Boxes of people: how they are matched, and what is counted."""
import numpy as np

LEAST_HEIGHT = {"camera": 9.0, "thermal": 6.0}  # pixels of the input: smaller people are neither learnt nor punished
OVERLAP = 0.5  # intersection over union from which on a box has found a person


def overlap(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Intersection over union of boxes N×4 and M×4 (left, top, right, bottom): N×M."""
    low = np.maximum(a[:, None, :2], b[None, :, :2])
    high = np.minimum(a[:, None, 2:4], b[None, :, 2:4])
    both = np.prod(np.maximum(high - low, 0), axis=2)
    area_a, area_b = (np.prod(x[:, 2:4] - x[:, :2], axis=1) for x in (a, b))
    return both / np.maximum(area_a[:, None] + area_b[None] - both, 1e-9)


def suppress(boxes: np.ndarray, threshold: float) -> np.ndarray:
    """Of boxes N×5 (with scores) that overlap more than `threshold`, the weaker go. Best first, as select_boxes() does."""
    kept: list[np.ndarray] = []
    for box in boxes[np.argsort(-boxes[:, 4], kind="stable")]:
        if not kept or overlap(box[None], np.stack(kept)).max() <= threshold:
            kept.append(box)
    return np.stack(kept) if kept else np.zeros((0, 5), np.float32)


class Tally:
    """Found boxes against true ones, over many pictures."""

    def __init__(self, least_height: float) -> None:
        self.least_height = least_height  # pixels; smaller people need not be found, and do no harm if they are
        self.scores: list[float] = []  # of found boxes that count
        self.right: list[bool] = []
        self.truth: list[tuple[float, float, float]] = []  # height, share, score of the box that found the person, or 0

    def add(self, found: np.ndarray, people: np.ndarray) -> None:
        """`found` N×5, best first; `people` M×5. Each person is found once, by the best box that fits."""
        overlaps = overlap(found, people)
        taken = np.zeros(len(people))
        for i, box in enumerate(found):
            free = np.where(taken == 0, overlaps[i], 0.0) if len(people) else np.zeros(0)
            best = int(free.argmax()) if len(free) else -1
            right = best >= 0 and free[best] >= OVERLAP
            if right:
                taken[best] = box[4]
                if not self.counts(people[best]):
                    continue
            self.scores.append(float(box[4]))
            self.right.append(bool(right))
        for person, score in zip(people, taken):
            if self.counts(person):
                self.truth.append((float(person[3] - person[1]), float(person[4]), float(score)))

    def counts(self, person: np.ndarray) -> bool:
        return bool(person[3] - person[1] >= self.least_height)

    def precision(self, threshold: float) -> float:
        kept = [right for score, right in zip(self.scores, self.right) if score >= threshold]
        return float("nan") if not kept else sum(kept) / len(kept)

    def recall(self, threshold: float, heights: tuple[float, float] = (0, 1e9), least_share: float = 0) -> float:
        found = [score >= threshold for height, share, score in self.truth
                 if heights[0] <= height < heights[1] and share >= least_share]
        return float("nan") if not found else sum(found) / len(found)

    def people(self, heights: tuple[float, float] = (0, 1e9), least_share: float = 0) -> int:
        return sum(heights[0] <= h < heights[1] and share >= least_share for h, share, _ in self.truth)

    def average_precision(self) -> float:
        """Area below precision over recall, precision made non-increasing (PASCAL VOC 2010)."""
        if not self.truth:
            return float("nan")
        order = np.argsort(-np.array(self.scores), kind="stable")
        right = np.array(self.right, float)[order]
        found = np.cumsum(right)
        precision = np.maximum.accumulate((found / np.arange(1, len(found) + 1))[::-1])[::-1]
        return float(np.sum(precision * right) / len(self.truth))

    def best_threshold(self) -> float:
        """Where 2PR / (P + R) is largest."""
        def f1(threshold: float) -> float:
            p, r = self.precision(threshold), self.recall(threshold)
            return 0.0 if np.isnan(p) or np.isnan(r) or p + r == 0 else 2 * p * r / (p + r)
        return max(np.arange(0.1, 0.9, 0.01), key=f1)
