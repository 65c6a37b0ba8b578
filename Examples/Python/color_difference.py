"""The colour difference CIEDE2000 of sRGB colours."""
import numpy as np

WHITE = np.array([0.95047, 1.0, 1.08883])  # D65
TO_XYZ = np.array([[0.4124564, 0.3575761, 0.1804375],
                   [0.2126729, 0.7151522, 0.0721750],
                   [0.0193339, 0.1191920, 0.9503041]])


def lab(colours):
    """CIELAB, (n, 3), of sRGB colours from 0 to 1, which are clipped to this range."""
    encoded = np.clip(colours, 0, 1)
    light = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    xyz = light @ TO_XYZ.T / WHITE
    f = np.where(xyz > 216 / 24389, np.cbrt(xyz), (24389 / 27 * xyz + 16) / 116)
    return np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], 1)


def ciede2000(first, second):
    """The CIEDE2000 difference of CIELAB colours, (n, 3) each, with kL = kC = kH = 1 (G. Sharma,
    W. Wu, E. Dalal, Color Research and Application 30(1), 2005, equations 2 to 22)."""
    l1, a1, b1 = np.asarray(first, float).T
    l2, a2, b2 = np.asarray(second, float).T
    seventh = ((np.hypot(a1, b1) + np.hypot(a2, b2)) / 2) ** 7
    stretch = 1 + 0.5 * (1 - np.sqrt(seventh / (seventh + 25.0 ** 7)))
    chroma1, chroma2 = np.hypot(stretch * a1, b1), np.hypot(stretch * a2, b2)
    hue1 = np.degrees(np.arctan2(b1, stretch * a1)) % 360
    hue2 = np.degrees(np.arctan2(b2, stretch * a2)) % 360
    hue1, hue2 = np.where(chroma1 == 0, 0, hue1), np.where(chroma2 == 0, 0, hue2)
    grey = chroma1 * chroma2 == 0

    half = 180 + 1e-9  # with round-off of opposite hues
    turn = hue2 - hue1
    turn = np.where(turn > half, turn - 360, np.where(turn < -half, turn + 360, turn))
    turn = np.where(grey, 0, turn)
    lightness, chroma = l2 - l1, chroma2 - chroma1
    hue = 2 * np.sqrt(chroma1 * chroma2) * np.sin(np.radians(turn / 2))

    mean_lightness, mean_chroma = (l1 + l2) / 2, (chroma1 + chroma2) / 2
    total = hue1 + hue2
    mean_hue = np.where(np.abs(hue1 - hue2) <= half, total,
                        np.where(total < 360, total + 360, total - 360)) / 2
    mean_hue = np.where(grey, total, mean_hue)

    def cosine(factor, shift):
        return np.cos(np.radians(factor * mean_hue + shift))

    t = (1 - 0.17 * cosine(1, -30) + 0.24 * cosine(2, 0) + 0.32 * cosine(3, 6)
         - 0.20 * cosine(4, -63))
    square = (mean_lightness - 50) ** 2
    lightness = lightness / (1 + 0.015 * square / np.sqrt(20 + square))
    chroma = chroma / (1 + 0.045 * mean_chroma)
    hue = hue / (1 + 0.015 * mean_chroma * t)
    seventh = mean_chroma ** 7
    rotation = (-2 * np.sqrt(seventh / (seventh + 25.0 ** 7))
                * np.sin(np.radians(60 * np.exp(-((mean_hue - 275) / 25) ** 2))))
    return np.sqrt(lightness ** 2 + chroma ** 2 + hue ** 2 + rotation * chroma * hue)


def mean_difference(first, second):
    """The mean CIEDE2000 difference of sRGB colours from 0 to 1."""
    return ciede2000(lab(first), lab(second)).mean()
