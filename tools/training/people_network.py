# SPDX-License-Identifier: Apache-2.0
"""The shipped people detectors: a small backbone of plain convolutions and one grid of boxes.

Both are of the family yolox (docs/perception.md): for each cell of 8x8 pixels a row of x, y, width, height, the score of
there being a person, and the score of the only class, which is always 1.
"""
import dataclasses

import torch
from torch import nn

import network

STRIDE = 8
MEAN, SCALE = 127.5, 1.0 / 64.0  # input = (pixel - MEAN) * SCALE
COLUMNS = 6
CERTAIN = 20.0  # its sigmoid is 1


@dataclasses.dataclass(frozen=True)
class Kind:
    """One of the two detectors."""

    name: str  # of the file
    planes: int
    width: int
    height: int
    channels: tuple[int, int, int, int]  # at 1/2, 1/4, 1/8 and, where it is not 0, 1/16 of the size


KINDS = {
    "camera": Kind("cairn-people-visible", 3, 336, 192, (16, 24, 48, 64)),
    "thermal": Kind("cairn-people-thermal", 1, 160, 120, (12, 24, 40, 0)),
}


class People(nn.Module):
    """Picture N×planes×H×W -> raw boxes N×5×H/8×W/8: x, y, log width, log height in cells, and the logit of a person."""

    def __init__(self, kind: Kind) -> None:
        super().__init__()
        half, quarter, eighth, deep = kind.channels
        self.near = nn.Sequential(
            network.conv(kind.planes, half, stride=2),
            network.conv(half, quarter, stride=2), network.Residual(quarter),
            network.conv(quarter, eighth, stride=2), network.Residual(eighth))
        self.deep = None
        if deep > 0:
            self.deep = nn.Sequential(
                network.conv(eighth, deep, stride=2), network.Wide(deep, 1), network.Wide(deep, 2),
                network.Wide(deep, 3), network.conv(deep, eighth, 1))
            self.mix = network.Residual(eighth)
        else:
            self.mix = nn.Sequential(network.Wide(eighth, 2), network.Wide(eighth, 3), network.Wide(eighth, 2))
        self.head = network.conv(eighth, eighth)
        self.boxes = nn.Conv2d(eighth, COLUMNS - 1, 1)
        nn.init.zeros_(self.boxes.weight)
        nn.init.constant_(self.boxes.bias[:4], 0.5)  # the middle of a cell, 1.6 cells in size
        nn.init.constant_(self.boxes.bias[4:], -4.0)  # nobody

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        near = self.near(x)
        if self.deep is not None:
            near = near + network.double(self.deep(near))
        return self.boxes(self.head(self.mix(near)))


class Exported(nn.Module):
    """What is shipped: rows as the family yolox has them."""

    def __init__(self, people: People) -> None:
        super().__init__()
        self.people = people
        old = people.boxes
        self.boxes = nn.Conv2d(old.in_channels, COLUMNS, 1)  # with the class's column, which is certain
        with torch.no_grad():
            self.boxes.weight.zero_()
            self.boxes.weight[:-1] = old.weight
            self.boxes.bias[:-1] = old.bias
            self.boxes.bias[-1] = CERTAIN
        people.boxes = nn.Identity()

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        raw = self.boxes(self.people(x))
        scored = torch.cat([raw[:, :4], torch.sigmoid(raw[:, 4:])], 1)
        return scored.flatten(2).permute(0, 2, 1)


def export(people: People, kind: Kind, path: str) -> None:
    """Writes ONNX, opset 11, for a batch of one: input "picture", output "boxes". Takes `people` apart."""
    rows = Exported(people).eval()
    torch.onnx.export(rows, torch.zeros(1, kind.planes, kind.height, kind.width), path, opset_version=11,
                      input_names=["picture"], output_names=["boxes"], do_constant_folding=True)
