"""Portal frame, slope "direction": the closed characteristic equation with 40 digits."""
from mpmath import *
mp.dps = 40
def root(w, E=mpf("210e9"), h=mpf(1), b=mpf(1), flexible=True):
    w = mpf(w); EA, EI = E * w**2, E * w**4 / 12
    def f(k):
        c = k * k                                   # P / (Lambda EI)
        L2 = 1 - 2 * EI * c / EA                    # Lambda^2
        l = b / 2
        kc = EA * (3 * L2 - 1) / (2 * h)
        K = 1 / (l / (3 * EI) + (1 / (l * l * kc) if flexible else 0))
        return EI * k * cos(k * h) + K / L2 * sin(k * h)
    k = findroot(f, (mpf("2.70") / h, mpf("2.72") / h), tol=1e-60)
    L = sqrt(1 - 2 * EI * k * k / EA)
    return k * h, L, EI * k * k * L, EI * k * k
if __name__ == "__main__":
    x = findroot(lambda x: tan(x) + x / 6, mpf("2.7"))
    print("Euler, tan x = -x/6: x =", nstr(x, 20), " x^2 =", nstr(x * x, 20))
    for w in ("0.1", "0.01", "0.001"):
        k, L, P, _ = root(w)
        EI = mpf("210e9") * mpf(w)**4 / 12
        print(f"w {w}: k h {nstr(k, 18)}  Lambda {nstr(L, 18)}  P_c {nstr(P, 18)} N   P_c h^2/EI {nstr(P / EI, 18)}  Euler {nstr(x * x * EI, 18)}  P_c/Euler - 1 = {nstr(P/(x*x*EI)-1, 12)}")
