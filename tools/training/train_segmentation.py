#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Trains the segmentation network that Cairn ships, on one core, with Debian's python3-torch.

    tools/training/train_segmentation.py DATA OUT [--epochs 24] [--whole 4] [--batch 16] [--threads 1]
                                         [--from CHECKPOINT] [--rate 4e-3] [--balance 1]

DATA is what make_data.sh left. OUT gets the network after each epoch: last.pt to go on from, best.pt and
cairn-segmentation.onnx of the epoch with the best mean IoU on the validation pictures, and log.txt.
An interrupted call goes on after the last epoch. The same data and thread count give the same network.
--from begins with the weights of another training (its last.pt or best.pt) and a fresh schedule.
--rate is the highest learning rate. --balance is how much more rare classes count: 0 not at all, 1 as in ENet.
"""
import argparse
import copy
import math
import pathlib
import time

import cv2
import numpy as np
import torch

import figures
import network
import pictures

SEED = 19
WEIGHT_DECAY = 1e-3
AVERAGE = 0.998  # of the running mean of the weights, a step


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--epochs", type=int, default=24)
    parser.add_argument("--whole", type=int, default=4, help="epochs at the end that learn from whole pictures")
    parser.add_argument("--batch", type=int, default=16)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--from", type=pathlib.Path, dest="start", metavar="CHECKPOINT")
    parser.add_argument("--rate", type=float, default=4e-3)
    parser.add_argument("--balance", type=float, default=1.0)
    return parser.parse_args()


def class_weights(truth: np.ndarray, balance: float) -> torch.Tensor:
    """Rare classes count more: 1 / ln(1.02 + share) to the power of `balance`. Absent ones count nothing.

    With the power 1 these are the weights of ENet (Paszke et al., 2016).
    """
    counts = np.bincount(truth[truth < network.CLASSES].ravel(), minlength=network.CLASSES)
    shares = counts / counts.sum()
    weights = np.where(counts > 0, np.log(1.02 + shares) ** -balance, 0.0)
    return torch.tensor(weights / weights[counts > 0].min(), dtype=torch.float32)


def to_input(batch: np.ndarray) -> torch.Tensor:
    scaled = (batch.astype(np.float32) - network.MEAN) * network.SCALE
    return torch.from_numpy(scaled).permute(0, 3, 1, 2)  # channels last in memory: the faster layout


def learning_rate(most: float, step: int, steps: int) -> float:
    warm = min(1.0, (step + 1) / 200)
    return most * warm * (0.5 + 0.5 * math.cos(math.pi * step / steps)) + 1e-6


def weights_in(checkpoint: pathlib.Path) -> dict[str, torch.Tensor]:
    """The running mean of the weights that a training left: last.pt holds it among other things, best.pt alone."""
    state = torch.load(checkpoint)
    return state.get("mean", state)


class Trainer:
    def __init__(self, args: argparse.Namespace) -> None:
        self.args = args
        self.pictures, self.truth, _ = pictures.load(args.data / "train")
        self.judged, self.judged_truth, _ = pictures.load(args.data / "validation")
        self.net = network.Segmentation().to(memory_format=torch.channels_last)
        if args.start is not None:
            self.net.load_state_dict(weights_in(args.start))
        self.mean = copy.deepcopy(self.net)
        self.optimizer = torch.optim.AdamW(self.net.parameters(), lr=args.rate, weight_decay=WEIGHT_DECAY)
        weights = class_weights(self.truth, args.balance)
        self.loss = torch.nn.CrossEntropyLoss(weights, ignore_index=pictures.IGNORED)
        self.epoch, self.best, self.seconds = 0, 0.0, 0.0
        self.steps = len(self.pictures) // args.batch
        self.resume()

    def resume(self) -> None:
        last = self.args.out / "last.pt"
        if not last.exists():
            return
        state = torch.load(last)
        self.net.load_state_dict(state["net"])
        self.mean.load_state_dict(state["mean"])
        self.optimizer.load_state_dict(state["optimizer"])
        self.epoch, self.best, self.seconds = state["epoch"], state["best"], state["seconds"]

    def save(self) -> None:
        torch.save({"net": self.net.state_dict(), "mean": self.mean.state_dict(),
                    "optimizer": self.optimizer.state_dict(), "epoch": self.epoch, "best": self.best,
                    "seconds": self.seconds}, self.args.out / "last.pt")

    def batch(self, chosen: np.ndarray, random: np.random.Generator) -> tuple[torch.Tensor, torch.Tensor]:
        view = pictures.PART if self.epoch < self.args.epochs - self.args.whole else pictures.WHOLE
        varied = [pictures.vary(self.pictures[i], self.truth[i], random, view) for i in chosen]
        truth = np.stack([known[1::2, 1::2] for _, known in varied])
        return to_input(np.stack([seen for seen, _ in varied])), torch.from_numpy(truth.astype(np.int64))

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
        order, total = random.permutation(len(self.pictures)), 0.0
        for i in range(self.steps):
            step = self.epoch * self.steps + i
            for group in self.optimizer.param_groups:
                group["lr"] = learning_rate(self.args.rate, step, self.args.epochs * self.steps)
            seen, truth = self.batch(order[i * self.args.batch:(i + 1) * self.args.batch], random)
            self.optimizer.zero_grad()
            loss = self.loss(self.net(seen), truth)
            loss.backward()
            self.optimizer.step()
            self.average(step)
            total += float(loss)
        return total / self.steps

    @torch.no_grad()
    def judge(self) -> np.ndarray:
        self.mean.eval()
        counts = np.zeros((network.CLASSES, network.CLASSES), np.int64)
        for i in range(0, len(self.judged), 16):
            said = self.mean(to_input(self.judged[i:i + 16])).argmax(1).numpy()
            counts += figures.confusion(self.judged_truth[i:i + 16, 1::2, 1::2], said)
        return counts

    def keep_best(self, score: float) -> None:
        if score <= self.best:
            return
        self.best = score
        torch.save(self.mean.state_dict(), self.args.out / "best.pt")
        network.export(copy.deepcopy(self.mean), str(self.args.out / "cairn-segmentation.onnx"))

    def run(self) -> None:
        while self.epoch < self.args.epochs:
            begin = time.monotonic()
            loss, counts = self.train_epoch(), self.judge()
            self.epoch += 1
            self.seconds += time.monotonic() - begin
            self.keep_best(figures.mean_iou(counts))
            self.save()
            self.say(f"epoch {self.epoch}: loss {loss:.4f}, validation accuracy {figures.accuracy(counts):.4f}, "
                     f"mIoU {figures.mean_iou(counts):.4f}, {self.seconds / 3600:.2f} h\n"
                     f"  {' '.join(f'{value:.2f}' for value in figures.iou(counts))}")

    def say(self, text: str) -> None:
        print(text, flush=True)
        with open(self.args.out / "log.txt", "a", encoding="utf-8") as log:
            log.write(text + "\n")


def main() -> None:
    args = arguments()
    args.out.mkdir(parents=True, exist_ok=True)
    torch.manual_seed(SEED)
    torch.set_num_threads(args.threads)
    cv2.setNumThreads(args.threads)
    trainer = Trainer(args)
    trainer.say(f"{len(trainer.pictures)} pictures to learn, {len(trainer.judged)} to judge, "
                f"{network.parameters(trainer.net)} parameters, {args.epochs} epochs of {trainer.steps} steps")
    trainer.run()


if __name__ == "__main__":
    main()
