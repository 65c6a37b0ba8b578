"""
A painted vase with noise and scratches
=======================================

Total variation removes the noise of colours and keeps their edges. Missing colours are filled in.
"""
import numpy as np
from surfacediffusion import Surface, intrinsic_tv, sphere
from surfacediffusion.examples import show

# A ball that is turned into a vase
ball = sphere(5)
width = 1 + 0.35 * np.sin(4 * ball.points[:, 1])
points, faces = ball.points * np.column_stack([width, np.full(width.shape, 1.4), width]), ball.triangles
surface = Surface(points, faces)
random = np.random.default_rng(0)

# %%
# Three colours in stripes, with noise, and a tenth of the points missing.
size = np.ptp(points, axis=0).max()
stripe = np.floor(3 * (points[:, 1] + 0.15 * points[:, 0]) / size).astype(int) % 3
paint = np.array([(205, 60, 50), (245, 220, 160), (50, 110, 150)])[stripe].astype(float)
noisy = np.clip(paint + random.normal(scale=30, size=paint.shape), 0, 255)
missing = np.abs(np.sin(25 * points[:, 0] / size + 11 * points[:, 2] / size)) < 0.15
result = intrinsic_tv(surface, noisy, mask=missing, mode="SteadyState", automatic_fidelity=True)

# %%
torn = np.where(missing[:, None], 255, noisy).astype(np.uint8)
show(points, faces, {"painted": torn, "restored": np.clip(result, 0, 255).astype(np.uint8)})
before, after = (np.sqrt(np.mean((a - paint) ** 2)) for a in (noisy, result))
print(f"error {before:.0f} before, {after:.0f} after, of 255")
assert after < 0.5 * before
