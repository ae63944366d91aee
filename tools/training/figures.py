# SPDX-License-Identifier: Apache-2.0
"""Confusion of classes and what follows from it."""
import numpy as np

NAMES = ("road", "sidewalk", "building", "wall", "fence", "pole", "traffic light", "traffic sign", "vegetation",
         "terrain", "sky", "person", "rider", "car", "truck", "bus", "train", "motorcycle", "bicycle")


def confusion(truth: np.ndarray, said: np.ndarray) -> np.ndarray:
    """19×19 counts of pixels: row = truth, column = what the network says. Pixels without a class do not count."""
    known = truth < len(NAMES)
    pairs = truth[known].astype(np.int64) * len(NAMES) + said[known]
    return np.bincount(pairs, minlength=len(NAMES) ** 2).reshape(len(NAMES), len(NAMES))


def accuracy(counts: np.ndarray) -> float:
    return float(np.trace(counts) / max(1, counts.sum()))


def iou(counts: np.ndarray) -> np.ndarray:
    """Of each class; NaN where the truth has none of it."""
    right = np.diag(counts).astype(np.float64)
    union = counts.sum(0) + counts.sum(1) - right
    return np.where(counts.sum(1) > 0, right / np.maximum(1, union), np.nan)


def mean_iou(counts: np.ndarray) -> float:
    return float(np.nanmean(iou(counts)))


def worst_confusions(counts: np.ndarray, most: int = 10) -> list[tuple[str, str, float]]:
    """Pairs (truth, said, share of the truth's pixels), the largest shares first."""
    shares = counts / np.maximum(1, counts.sum(1, keepdims=True))
    np.fill_diagonal(shares, 0)
    order = np.argsort(-shares, axis=None)[:most]
    rows, columns = np.unravel_index(order, shares.shape)
    return [(NAMES[r], NAMES[c], float(shares[r, c])) for r, c in zip(rows, columns) if shares[r, c] > 0]
