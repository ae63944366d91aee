#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Trains a people detector that Cairn ships, on one core, with Debian's python3-torch.

    tools/training/train_people.py KIND DATA OUT [--labelled FOLDER] [--epochs 40] [--whole 8] [--batch 16] [--threads N]

KIND is camera or thermal. DATA is what make_people_data.sh left. FOLDER is what make_data.sh left: the visible detector
learns from its pictures, too. OUT gets the network after each epoch: KIND.last.pt to
go on from, and of the epoch with the best average precision on the validation pictures the file that is shipped.
An interrupted call goes on after the last epoch. The same data and thread count give the same network.
"""
import argparse
import copy
import math
import pathlib
import time

import cv2
import numpy as np
import torch

import people_boxes
import people_network
import people_pictures
from people_network import STRIDE

SEED = 23
MOST_RATE, WEIGHT_DECAY = 3e-3, 1e-3
AVERAGE = 0.998  # of the running mean of the weights, a step
LEAST_SHARE = 0.2  # of a person who is to be found
REACH = 1.2  # cells from a box's middle within which a cell answers for it


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=list(people_network.KINDS))
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--labelled", type=pathlib.Path, help="pictures with classes, of make_data.sh")
    parser.add_argument("--epochs", type=int, default=40)
    parser.add_argument("--whole", type=int, default=8, help="epochs at the end that learn from whole pictures")
    parser.add_argument("--batch", type=int, default=16)
    parser.add_argument("--threads", type=int, default=1)
    return parser.parse_args()


def to_input(batch: np.ndarray) -> torch.Tensor:
    scaled = (batch.astype(np.float32) - people_network.MEAN) * people_network.SCALE
    if scaled.ndim == 3:
        return torch.from_numpy(scaled[:, None])
    return torch.from_numpy(scaled).permute(0, 3, 1, 2)  # channels last in memory: the faster layout


def targets(people: np.ndarray, dark: bool, rows: int, columns: int, least_height: float) -> np.ndarray:
    """What each cell is to say: left, top, right, bottom in pixels and a role: 1 a person, 0 nobody, -1 not asked.

    A cell near a box's middle answers for it; where two boxes meet, for the smaller one, which is farther away and would
    else be lost. The cells around them are not asked, and no cell of a person who is too small or too hidden.
    """
    cells = np.zeros((rows, columns, 5), np.float32)
    y, x = np.mgrid[:rows, :columns]
    middle_x, middle_y = (x + 0.5) * STRIDE, (y + 0.5) * STRIDE
    order = np.argsort(-(people[:, 2] - people[:, 0]) * (people[:, 3] - people[:, 1]), kind="stable")
    for left, top, right, bottom, share in people[order]:
        inside = (middle_x >= left) & (middle_x < right) & (middle_y >= top) & (middle_y < bottom)
        centre_x, centre_y = (left + right) / 2, (top + bottom) / 2
        distance = np.maximum(np.abs(middle_x - centre_x), np.abs(middle_y - centre_y)) / STRIDE
        own = (x == min(int(centre_x / STRIDE), columns - 1)) & (y == min(int(centre_y / STRIDE), rows - 1))
        asked = bottom - top >= least_height and share >= LEAST_SHARE and not dark
        if asked:
            cells[inside & (distance < 2 * REACH) & (cells[..., 4] == 0), 4] = -1
            cells[inside & (distance < REACH) | own] = (left, top, right, bottom, 1)
        else:
            cells[inside | own, 4] = -1
    return cells


def boxes_of(raw: torch.Tensor) -> torch.Tensor:
    """N×6 or 5×H×W of the network -> N×4×H×W: left, top, right, bottom in pixels."""
    rows, columns = raw.shape[2:]
    y = torch.arange(rows, dtype=torch.float32)[:, None]
    x = torch.arange(columns, dtype=torch.float32)[None]
    centre_x, centre_y = (raw[:, 0] + x) * STRIDE, (raw[:, 1] + y) * STRIDE
    half_width = raw[:, 2].clamp(-4, 5).exp() * STRIDE / 2
    half_height = raw[:, 3].clamp(-4, 5).exp() * STRIDE / 2
    return torch.stack([centre_x - half_width, centre_y - half_height, centre_x + half_width, centre_y + half_height], 1)


def generalised_overlap(a: torch.Tensor, b: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """IoU and GIoU (Rezatofighi et al., 2019) of boxes N×4 in pairs."""
    low, high = torch.maximum(a[:, :2], b[:, :2]), torch.minimum(a[:, 2:], b[:, 2:])
    both = (high - low).clamp(min=0).prod(1)
    union = (a[:, 2:] - a[:, :2]).prod(1) + (b[:, 2:] - b[:, :2]).prod(1) - both
    hull = (torch.maximum(a[:, 2:], b[:, 2:]) - torch.minimum(a[:, :2], b[:, :2])).prod(1)
    iou = both / union.clamp(min=1e-6)
    return iou, iou - (hull - union) / hull.clamp(min=1e-6)


def loss_of(raw: torch.Tensor, truth: torch.Tensor) -> torch.Tensor:
    """Box loss 1 - GIoU; scores learn the overlap that their box reaches (Zhang et al., VarifocalNet, 2021)."""
    role = truth[..., 4]
    person = role == 1
    count = person.sum().clamp(min=1)
    wanted = torch.zeros_like(role)
    box_loss = raw.sum() * 0
    if person.any():
        said = boxes_of(raw).permute(0, 2, 3, 1)[person]
        iou, giou = generalised_overlap(said, truth[..., :4][person])
        box_loss = (1 - giou).sum() / count
        wanted[person] = iou.detach().clamp(min=0.3)
    logit = raw[:, 4]
    score = torch.sigmoid(logit).detach()
    weight = torch.where(person, wanted, 0.75 * score ** 2) * (role >= 0)
    each = torch.nn.functional.binary_cross_entropy_with_logits(logit, wanted, reduction="none")
    return 2 * box_loss + (weight * each).sum() / count


def found_in(raw: torch.Tensor, threshold: float = 0.05) -> list[np.ndarray]:
    """For each picture the boxes N×5 above the threshold, as Cairn would keep them."""
    boxes = boxes_of(raw).permute(0, 2, 3, 1).flatten(1, 2)
    scores = torch.sigmoid(raw[:, 4]).flatten(1)
    return [people_boxes.suppress(np.concatenate([b[s >= threshold].numpy(), s[s >= threshold, None].numpy()], 1), 0.45)
            for b, s in zip(boxes, scores)]


def learning_rate(step: int, steps: int) -> float:
    warm = min(1.0, (step + 1) / 100)
    return MOST_RATE * warm * (0.5 + 0.5 * math.cos(math.pi * step / steps)) + 1e-6


class Trainer:
    def __init__(self, args: argparse.Namespace) -> None:
        self.args, self.kind = args, people_network.KINDS[args.kind]
        self.learnt = people_pictures.load(args.data / "train", args.kind)
        if args.labelled is not None:
            self.learnt += people_pictures.load_labelled(args.labelled / "train")
        self.judged = people_pictures.load(args.data / "validation", args.kind)
        self.net = people_network.People(self.kind).to(memory_format=torch.channels_last)
        self.mean = copy.deepcopy(self.net)
        self.optimizer = torch.optim.AdamW(self.net.parameters(), lr=MOST_RATE, weight_decay=WEIGHT_DECAY)
        self.epoch, self.best, self.seconds = 0, 0.0, 0.0
        self.shown = np.array([i for i, example in enumerate(self.learnt) if self.shows(example)])
        self.empty = np.setdiff1d(np.arange(len(self.learnt)), self.shown)
        self.steps = len(self.order(np.random.default_rng())) // args.batch
        self.resume()

    def shows(self, example: people_pictures.Example) -> bool:
        """Whether somebody can be learnt from it."""
        people = example.people
        tall = people[:, 3] - people[:, 1] >= people_boxes.LEAST_HEIGHT[self.args.kind]
        return not example.dark and bool(np.any(tall & (people[:, 4] >= LEAST_SHARE)))

    def order(self, random: np.random.Generator) -> np.ndarray:
        """What an epoch learns from: all pictures of people, and half as many others."""
        few = random.permutation(self.empty)[:len(self.shown) // 2]
        return random.permutation(np.concatenate([self.shown, few]))

    def file(self, end: str) -> pathlib.Path:
        return self.args.out / f"{self.args.kind}.{end}"

    def resume(self) -> None:
        if not self.file("last.pt").exists():
            return
        state = torch.load(self.file("last.pt"))
        self.net.load_state_dict(state["net"])
        self.mean.load_state_dict(state["mean"])
        self.optimizer.load_state_dict(state["optimizer"])
        self.epoch, self.best, self.seconds = state["epoch"], state["best"], state["seconds"]

    def save(self) -> None:
        torch.save({"net": self.net.state_dict(), "mean": self.mean.state_dict(),
                    "optimizer": self.optimizer.state_dict(), "epoch": self.epoch, "best": self.best,
                    "seconds": self.seconds}, self.file("last.pt"))

    def batch(self, chosen: np.ndarray, random: np.random.Generator) -> tuple[torch.Tensor, torch.Tensor]:
        views = people_pictures.PART if self.epoch < self.args.epochs - self.args.whole else people_pictures.WHOLE
        view = views[self.args.kind]
        seen, truth = [], []
        for i in chosen:
            picture, people = people_pictures.vary(self.learnt[i], random, view)
            seen.append(picture)
            truth.append(targets(people, self.learnt[i].dark, view.height // STRIDE, view.width // STRIDE,
                                 people_boxes.LEAST_HEIGHT[self.args.kind]))
        return to_input(np.stack(seen)), torch.from_numpy(np.stack(truth))

    def average(self, step: int) -> None:
        """The running mean of weights; that of the norms' statistics, too."""
        keep = min(AVERAGE, (step + 1) / (step + 10))
        now = self.net.state_dict()
        for name, value in self.mean.state_dict().items():
            if value.dtype.is_floating_point:
                value.mul_(keep).add_(now[name], alpha=1 - keep)

    def train_epoch(self) -> float:
        self.net.train()
        random = np.random.default_rng([SEED, self.epoch])
        order, total = self.order(random), 0.0
        for i in range(self.steps):
            step = self.epoch * self.steps + i
            for group in self.optimizer.param_groups:
                group["lr"] = learning_rate(step, self.args.epochs * self.steps)
            seen, truth = self.batch(order[i * self.args.batch:(i + 1) * self.args.batch], random)
            self.optimizer.zero_grad()
            loss = loss_of(self.net(seen), truth)
            loss.backward()
            torch.nn.utils.clip_grad_norm_(self.net.parameters(), 10.0)
            self.optimizer.step()
            self.average(step)
            total += float(loss)
        return total / self.steps

    @torch.no_grad()
    def judge(self) -> people_boxes.Tally:
        self.mean.eval()
        tally = people_boxes.Tally(people_boxes.LEAST_HEIGHT[self.args.kind])
        lit = [example for example in self.judged if not example.dark]
        for i in range(0, len(lit), 16):
            part = lit[i:i + 16]
            raw = self.mean(to_input(np.stack([example.picture for example in part])))
            for example, found in zip(part, found_in(raw)):
                tally.add(found, example.people)
        return tally

    def keep_best(self, score: float) -> None:
        if score <= self.best:
            return
        self.best = score
        people_network.export(copy.deepcopy(self.mean), self.kind, str(self.args.out / f"{self.kind.name}.onnx"))

    def run(self) -> None:
        while self.epoch < self.args.epochs:
            begin = time.monotonic()
            loss, tally = self.train_epoch(), self.judge()
            self.epoch += 1
            self.seconds += time.monotonic() - begin
            score, threshold = tally.average_precision(), tally.best_threshold()
            self.keep_best(score)
            self.save()
            self.say(f"epoch {self.epoch}: loss {loss:.4f}, validation AP50 {score:.4f}, best at {threshold:.2f}: "
                     f"precision {tally.precision(threshold):.3f}, recall {tally.recall(threshold):.3f}, "
                     f"{self.seconds / 3600:.2f} h")

    def say(self, text: str) -> None:
        print(text, flush=True)
        with open(self.file("log.txt"), "a", encoding="utf-8") as log:
            log.write(text + "\n")


def main() -> None:
    args = arguments()
    args.out.mkdir(parents=True, exist_ok=True)
    torch.manual_seed(SEED)
    torch.set_num_threads(args.threads)
    cv2.setNumThreads(args.threads)
    trainer = Trainer(args)
    weights = sum(p.numel() for p in trainer.net.parameters())
    trainer.say(f"{len(trainer.shown)} pictures of people and {len(trainer.empty)} others to learn, "
                f"{len(trainer.judged)} to judge, {weights} parameters, "
                f"{args.epochs} epochs of {trainer.steps} steps")
    trainer.run()


if __name__ == "__main__":
    main()
