"""Members of the energy EA/2 eps^2 + EI/2 r''.r'' by Chebyshev collocation on several intervals.

Unknown fields of a member, along its reference arc length s in [0, L]: x, y, stretch lam, double force m = EI lam', direction th,
couple M = EI lam^2 th'; unknown constants H, V, the internal force (on the part before a section, from the part after it).
    x' = lam cos th            y' = lam sin th
    lam' = m                   m' = EA/2 lam (lam^2 - 1) + M^2/lam^3 - (H cos th + V sin th)
    th' = M/lam^2              M' = -lam (V cos th - H sin th)
Units: EI = 1, lengths in m, so forces are in units of EI/m^2.  EA = 12/w^2 for a square section of side w."""
import numpy as np

def cheb(n):
    k = np.arange(n + 1)
    x = -np.cos(np.pi * k / n)
    c = np.where((k == 0) | (k == n), 2.0, 1.0) * (-1.0) ** k
    X = x[:, None] - x[None, :] + np.eye(n + 1)
    D = np.outer(c, 1 / c) / X
    D[k, k] = 0
    D[k, k] = -D.sum(axis=1)
    return x, D

X, Y, LAM, MU, TH, MO = range(6)

class Member:
    """Fields at all nodes; an interval shares no node with the next, continuity is a row."""
    def __init__(self, L, th0, start, breaks, n, EA):
        self.L, self.EA, self.n = L, EA, n
        b = np.asarray(breaks) * L
        xi, D = cheb(n)
        self.D = [D * 2 / (b1 - b0) for b0, b1 in zip(b, b[1:])]
        self.s = np.concatenate([(b0 + b1) / 2 + (b1 - b0) / 2 * xi for b0, b1 in zip(b, b[1:])])
        self.nodes = len(self.s)
        self.size = 6 * self.nodes + 2
        z = np.zeros((self.nodes, 6))
        z[:, X] = start[0] + self.s * np.cos(th0); z[:, Y] = start[1] + self.s * np.sin(th0)
        z[:, LAM] = 1; z[:, TH] = th0
        self.initial = np.concatenate([z.ravel(), [0.0, 0.0]])

    def rows(self, u, R, J, r0, c0):
        """6 (n) collocation rows per interval at all nodes but the first, 6 continuity rows between intervals: 6 short of fields"""
        z = u[:-2].reshape(-1, 6); H, V = u[-2:]
        lam, mu, th, M = z[:, LAM], z[:, MU], z[:, TH], z[:, MO]
        c, s = np.cos(th), np.sin(th)
        f = np.stack([lam * c, lam * s, mu, self.EA / 2 * lam * (lam**2 - 1) + M**2 / lam**3 - H * c - V * s,
                      M / lam**2, -lam * (V * c - H * s)], axis=1)
        cF = 6 * self.nodes + c0
        r, n1 = r0, self.n + 1
        for k, D in enumerate(self.D):
            i0 = k * n1
            dz = D @ z[i0:i0 + n1]
            for j in range(1, n1):
                i = i0 + j; c6 = c0 + 6 * i
                R[r:r + 6] = dz[j] - f[i]
                for q in range(6): J[r + q, c0 + 6 * i0 + q:c0 + 6 * (i0 + n1) + q:6] += D[j]
                J[r + X, c6 + LAM] -= c[i]; J[r + X, c6 + TH] += lam[i] * s[i]
                J[r + Y, c6 + LAM] -= s[i]; J[r + Y, c6 + TH] -= lam[i] * c[i]
                J[r + LAM, c6 + MU] -= 1
                J[r + MU, c6 + LAM] -= self.EA / 2 * (3 * lam[i]**2 - 1) - 3 * M[i]**2 / lam[i]**4
                J[r + MU, c6 + MO] -= 2 * M[i] / lam[i]**3
                J[r + MU, c6 + TH] -= H * s[i] - V * c[i]
                J[r + MU, cF] += c[i]; J[r + MU, cF + 1] += s[i]
                J[r + TH, c6 + MO] -= 1 / lam[i]**2; J[r + TH, c6 + LAM] += 2 * M[i] / lam[i]**3
                J[r + MO, c6 + LAM] += V * c[i] - H * s[i]
                J[r + MO, c6 + TH] += lam[i] * (-V * s[i] - H * c[i])
                J[r + MO, cF] -= lam[i] * s[i]; J[r + MO, cF + 1] += lam[i] * c[i]
                r += 6
            if k + 1 < len(self.D):
                a, b = c0 + 6 * (i0 + self.n), c0 + 6 * (i0 + n1)
                R[r:r + 6] = u[6 * (i0 + n1):6 * (i0 + n1) + 6] - u[6 * (i0 + self.n):6 * (i0 + self.n) + 6]
                J[range(r, r + 6), range(b, b + 6)] = 1
                J[range(r, r + 6), range(a, a + 6)] = -1
                r += 6
        return r

class Structure:
    """Members and linear boundary rows: each row is ([(member, end or 'F', component, coefficient)], value, load coefficient):
    sum of coefficient * quantity = value + load coefficient * P."""
    def __init__(self, members, bc):
        self.members, self.bc = members, bc
        self.off = np.concatenate([[0], np.cumsum([m.size for m in members])]).astype(int)
        self.N = self.off[-1]
        self.initial = np.concatenate([m.initial for m in members])
        assert len(bc) == 8 * len(members), len(bc)

    def col(self, k, where, comp):
        m = self.members[k]
        return self.off[k] + {"0": comp, "1": 6 * (m.nodes - 1) + comp, "F": 6 * m.nodes + comp}[where]

    def system(self, u, P, bc=None):
        R = np.zeros(self.N); J = np.zeros((self.N, self.N)); dP = np.zeros(self.N)
        r = 0
        for k, m in enumerate(self.members):
            r = m.rows(u[self.off[k]:self.off[k + 1]], R, J, r, self.off[k])
        for terms, value, load in bc or self.bc:
            for k, w, c, a in terms:
                j = self.col(k, w, c); J[r, j] += a; R[r] += a * u[j]
            R[r] -= value + load * P; dP[r] = -load
            r += 1
        assert r == self.N
        return R, J, dP

    def solve(self, u, P, tol=1e-11, it=40):
        for _ in range(it):
            R, J, _ = self.system(u, P)
            d = np.linalg.solve(J, -R); u = u + d
            if np.abs(d).max() < tol * (1 + np.abs(u).max()): return u
        raise RuntimeError("Newton")

    def solve_at(self, u, P, row, value, tol=1e-11, it=40):
        """P is unknown, the coordinate `row` of u has a given value; returns u, P, and dP/dvalue"""
        for _ in range(it):
            R, J, dP = self.system(u, P)
            B = np.zeros((self.N + 1,) * 2); B[:-1, :-1] = J; B[:-1, -1] = dP; B[-1, row] = 1
            d = np.linalg.solve(B, -np.append(R, u[row] - value)); u = u + d[:-1]; P += d[-1]
            if np.abs(d[:-1]).max() < tol * (1 + np.abs(u).max()): break
        else: raise RuntimeError("Newton")
        e = np.zeros(self.N + 1); e[-1] = 1
        return u, P, np.linalg.solve(B, e)[-1]

    def stiffness(self, u, P, bc, i, term):
        """Tangent stiffness: row i of bc (a balance) is replaced by `term = 1` (a term or
        a list of terms); the value of row i in that state. It vanishes where
        the tangent with the rows bc is singular."""
        moved = list(bc); moved[i] = (term if isinstance(term, list) else [term], 0, 0)
        _, J, _ = self.system(u, P, moved)
        e = np.zeros(self.N); e[self.N - len(bc) + i] = 1
        z = np.linalg.solve(J, e)
        return sum(a * z[self.col(k, w, c)] for k, w, c, a in bc[i][0])

    def sign(self, u, P, bc=None):
        _, J, _ = self.system(u, P, bc)
        return np.linalg.slogdet(J / np.abs(J).max(axis=1)[:, None])

def secant(f, a, b, tol=1e-13, it=50):
    fa, fb = f(a), f(b)
    for _ in range(it):
        if fb == fa: return b
        a, b, fa = b, b - fb * (b - a) / (fb - fa), fb
        if abs(b - a) < tol * abs(b): return b
        fb = f(b)
    raise RuntimeError("secant")
