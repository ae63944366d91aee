# SPDX-License-Identifier: Apache-2.0
"""The shipped segmentation network: a small encoder and decoder with plain convolutions.

Plain 3x3 convolutions are what OpenCV's DNN module computes fastest on a CPU. The picture is halved four times; the
deepest level sees the whole scene by dilation and a global mean. The decoder goes back to half the picture's size.
"""
import torch
from torch import nn

CLASSES = 19
WIDTH, HEIGHT = 336, 192  # pixels of the input
MEAN, SCALE = 127.5, 1.0 / 64.0  # input = (BGR - MEAN) * SCALE


def conv(inputs: int, outputs: int, size: int = 3, stride: int = 1, dilation: int = 1, groups: int = 1) -> nn.Sequential:
    padding = dilation * (size // 2)
    return nn.Sequential(
        nn.Conv2d(inputs, outputs, size, stride, padding, dilation, groups, bias=False),
        nn.BatchNorm2d(outputs),
        nn.ReLU(inplace=True),
    )


class Residual(nn.Module):
    """Two plain convolutions and a bridge over them."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.first = conv(channels, channels)
        self.second = nn.Sequential(nn.Conv2d(channels, channels, 3, 1, 1, bias=False), nn.BatchNorm2d(channels))

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return torch.relu(x + self.second(self.first(x)))


class Wide(nn.Module):
    """Depthwise dilated and pointwise convolutions, twice, and a bridge over them."""

    def __init__(self, channels: int, dilation: int) -> None:
        super().__init__()
        self.body = nn.Sequential(
            conv(channels, channels, 3, 1, dilation, channels),
            conv(channels, channels, 1),
            conv(channels, channels, 3, 1, 1, channels),
            nn.Conv2d(channels, channels, 1, bias=False),
            nn.BatchNorm2d(channels),
        )

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return torch.relu(x + self.body(x))


class Segmentation(nn.Module):
    """BGR picture N×3×192×336 -> logits N×19×96×168."""

    def __init__(self) -> None:
        super().__init__()
        self.stem = conv(3, 16, stride=2)
        self.quarter = nn.Sequential(conv(16, 32, stride=2), Residual(32))
        self.eighth = nn.Sequential(conv(32, 64, stride=2), Residual(64), Residual(64))
        self.sixteenth = nn.Sequential(conv(64, 96, stride=2), Wide(96, 1), Wide(96, 2), Wide(96, 4), Wide(96, 2))
        self.scene = nn.Sequential(nn.AdaptiveAvgPool2d(1), nn.Conv2d(96, 96, 1))
        self.up_sixteenth = conv(96, 64, 1)
        self.up_eighth = conv(64, 48)
        self.side_quarter = conv(32, 48, 1)
        self.up_quarter = conv(48, 32)
        self.up_half = nn.Conv2d(32, 24, 1, bias=False)
        self.side_half = nn.Sequential(nn.Conv2d(16, 24, 1, bias=False), nn.BatchNorm2d(24))
        self.logits = nn.Conv2d(24, CLASSES, 1)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        half = self.stem(x)
        quarter = self.quarter(half)
        eighth = self.eighth(quarter)
        deep = self.sixteenth(eighth)
        deep = torch.relu(deep + self.scene(deep))
        y = self.up_eighth(double(self.up_sixteenth(deep)) + eighth)
        y = self.up_quarter(double(y) + self.side_quarter(quarter))
        y = torch.relu(double(self.up_half(y)) + self.side_half(half))
        return self.logits(y)


def double(x: torch.Tensor) -> torch.Tensor:
    return nn.functional.interpolate(x, scale_factor=2.0, mode="bilinear", align_corners=False)


def parameters(network: nn.Module) -> int:
    return sum(p.numel() for p in network.parameters())


def export(network: nn.Module, path: str) -> None:
    """Writes ONNX, opset 11, for a batch of one: input "picture", output "logits"."""
    network.eval()
    torch.onnx.export(network, torch.zeros(1, 3, HEIGHT, WIDTH), path, opset_version=11, input_names=["picture"],
                      output_names=["logits"], do_constant_folding=True)
