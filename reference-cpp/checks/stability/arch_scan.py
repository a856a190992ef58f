import numpy as np, sys
from collocation import *
def half(h, w, n=14, breaks=(0, .004, .012, .03, .08, .2, .5, .8, .92, .97, .988, .996, 1), slope="direction"):
    L = np.hypot(1, h); th = np.arctan2(h, 1)
    m = Member(L, th, (-1, 0), breaks, n, 12 / w**2)
    clamp = ([(0, "0", LAM, 1)], 1, 0) if slope == "vector" else ([(0, "0", MU, 1)], 0, 0)
    base = [([(0, "0", X, 1)], -1, 0), ([(0, "0", Y, 1)], 0, 0), ([(0, "0", TH, 1)], th, 0), clamp]
    sym = base + [([(0, "1", X, 1)], 0, 0), ([(0, "F", 1, 1)], 0, -0.5), ([(0, "1", TH, 1)], th, 0), ([(0, "1", MU, 1)], 0, 0)]
    top = ([(0, "1", LAM, 1)], 0, 0) if slope == "vector" else ([(0, "1", MU, 1)], 0, 0)
    anti = base + [([(0, "1", Y, 1)], 0, 0), ([(0, "F", 0, 1)], 0, 0), ([(0, "1", MO, 1)], 0, 0), top]
    return Structure([m], sym), anti
if __name__ == "__main__":
    w = 0.01
    for h in map(float, sys.argv[1:]):
        S, anti = half(h, w)
        u, P = S.initial.copy(), 0.0
        row = S.col(0, "1", Y)
        s0 = S.sign(u, P, anti)[0]; ev = []; d0 = 1
        for y in np.linspace(h, -1.6 * h, 105)[1:]:
            u, P, dP = S.solve_at(u, P, row, y)
            s = S.sign(u, P, anti)[0]; d = np.sign(-dP)
            if s != s0: ev.append(("bifurcation", round(y / h, 3), P * 175))
            if d != d0: ev.append(("limit", round(y / h, 3), P * 175))
            s0, d0 = s, d
        print(h, ev, flush=True)
