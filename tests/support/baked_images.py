"""What baked images should show, computed from the maps and the texture, and where islands lie in them."""

import numpy as np
from scenes import uv_maps


def triangles(obj):
    """((#T, 3) loops, (#T,) areas) of an object, as Blender draws it."""
    obj.data.calc_loop_triangles()
    loops = np.array([tuple(triangle.loops) for triangle in obj.data.loop_triangles])
    return loops, np.array([triangle.area for triangle in obj.data.loop_triangles])


def pixels(image):
    """(height, width, 3), the lowest row first, as they are stored."""
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], -1)[..., :3]


def sampled(picture, uv, is_periodic=True):
    """(n, 3) bilinear values of a picture at (n, 2) UVs."""
    size = np.array(picture.shape[1::-1])
    at = np.asarray(uv, np.float64) * size - 0.5
    low = np.floor(at).astype(int)
    share = at - low

    def texel(du, dv):
        x, y = (low + (du, dv)).T
        if is_periodic:
            return picture[y % size[1], x % size[0]]
        return picture[np.clip(y, 0, size[1] - 1), np.clip(x, 0, size[0] - 1)]

    u, v = share.T[..., None]
    return (1 - v) * ((1 - u) * texel(0, 0) + u * texel(1, 0)) + v * ((1 - u) * texel(0, 1) + u * texel(1, 1))


class Points:
    """Random points of the surface of an object, by area: their UVs in its tiling and in its bake map."""

    def __init__(self, obj, count=10_000, seed=7):
        chance, (loops, areas) = np.random.default_rng(seed), triangles(obj)
        self.triangle = chance.choice(len(areas), count, p=areas / areas.sum())
        self._shares = chance.dirichlet((1, 1, 1), count)
        tiling, bake = (uv_maps.read_map(obj.data, name(obj.data)) for name in (uv_maps.main_map, uv_maps.bake_map))
        self._tiling, self._bake = (values.astype(np.float64)[loops[self.triangle]] for values in (tiling, bake))

    @property
    def tiling(self):
        return np.einsum("nk,nkd->nd", self._shares, self._tiling)

    @property
    def bake(self):
        return np.einsum("nk,nkd->nd", self._shares, self._bake)

    def in_middles(self, side):
        """Moves them to the middles of texels, those that leave their triangle excepted; how many there are."""
        middle = (np.floor(self.bake % 1 * side) + 0.5) / side + np.floor(self.bake)
        edges = self._bake[:, 1:] - self._bake[:, :1]
        with np.errstate(all="ignore"):
            inverse = np.linalg.pinv(edges.transpose(0, 2, 1))
        two = np.einsum("nij,nj->ni", inverse, middle - self._bake[:, 0])
        shares = np.column_stack([1 - two.sum(axis=1), two])
        is_in = (shares > 0.01).all(axis=1)
        for name in ("triangle", "_tiling", "_bake"):
            setattr(self, name, getattr(self, name)[is_in])
        self._shares = shares[is_in]
        return np.count_nonzero(is_in)

    def stretch(self):
        """(n,) the largest length in the tiling for a length in the bake map."""
        to_tiling, to_bake = (
            (corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1) for corners in (self._tiling, self._bake)
        )
        return np.linalg.norm(to_tiling @ np.linalg.pinv(to_bake), ord=2, axis=(1, 2))


def covering(obj, side, offset=(0, 0)):
    """(side, side) how many triangles of an object the middle of each texel lies in."""
    count = np.zeros((side, side), int)
    uv = uv_maps.read_map(obj.data, uv_maps.bake_map(obj.data)).astype(np.float64) - offset
    for corners in uv[triangles(obj)[0]] * side - 0.5:
        low, high = np.ceil(corners.min(axis=0)).astype(int), np.floor(corners.max(axis=0)).astype(int) + 1
        y, x = np.mgrid[low[1] : high[1], low[0] : high[0]]
        inside = np.ones(x.shape, bool)
        (ax, ay), (bx, by) = corners[1:] - corners[0]
        turn = np.sign(ax * by - ay * bx)
        for k in range(3):
            (ax, ay), (bx, by) = corners[k], corners[(k + 1) % 3]
            inside &= turn * ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) > 0
        count[low[1] : high[1], low[0] : high[0]] += inside
    return count


def grown(mask, texels):
    """A mask and all that is within so many steps of it."""
    for _ in range(texels):
        padded = np.pad(mask, 1)
        mask = padded[1:-1, 1:-1] | padded[:-2, 1:-1] | padded[2:, 1:-1] | padded[1:-1, :-2] | padded[1:-1, 2:]
    return mask


def islands(mask):
    """(labels of connected texels, 0 where there are none; their number)."""
    labels = np.where(mask, np.arange(1, mask.size + 1).reshape(mask.shape), 0)
    while True:
        padded = np.pad(labels, 1)
        around = np.max(
            [
                padded[1 + dy : padded.shape[0] - 1 + dy, 1 + dx : padded.shape[1] - 1 + dx]
                for dy in (-1, 0, 1)
                for dx in (-1, 0, 1)
            ],
            axis=0,
        )
        following = np.where(mask, around, 0)
        if np.array_equal(following, labels):
            _, numbered = np.unique(labels, return_inverse=True)
            numbered = numbered.reshape(mask.shape)
            return numbered, int(numbered.max())
        labels = following
