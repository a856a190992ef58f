"""The library through its C interface: make build/libreference.so"""
import ctypes as c
import pathlib

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
lib = c.CDLL(str(ROOT / "reference-cpp/build/libreference.so"))


class Error(c.Structure):
    _fields_ = [("code", c.c_int32), ("flag", c.c_int32), ("line", c.c_int32), ("column", c.c_int32),
                ("time", c.c_double), ("field", c.c_char * 128), ("message", c.c_char * 640)]


class Tolerances(c.Structure):
    _fields_ = [("relative", c.c_double), ("position", c.c_double), ("velocity", c.c_double), ("max_step", c.c_double),
                ("newton", c.c_double), ("max_order", c.c_int32), ("linear_solver", c.c_int32), ("max_steps", c.c_int64)]


class Description(c.Structure):
    _fields_ = [("title", c.c_char_p), ("is_static", c.c_int32), ("reserved", c.c_int32), ("duration", c.c_double),
                ("interval", c.c_double), ("initial_energy", c.c_double)]


for name in ("ls_scene_read", "ls_run_new"):
    getattr(lib, name).restype = c.c_void_p
lib.ls_scene_count.restype = c.c_size_t
lib.ls_scene_name.restype = c.c_char_p
error = Error()
COORDINATE, CONSTRAINT, JOINT, CHANNEL, SELECTED, REDUNDANT, STATE = range(7)


def pointer(x):
    return x.ctypes.data_as(c.POINTER(c.c_double))


def call(function, *arguments):
    if function(*arguments, c.byref(error)):
        raise RuntimeError(error.message.decode())


class Scene:
    def __init__(self, path):
        self.handle = c.c_void_p(lib.ls_scene_read(path.read_bytes(), None, c.c_size_t(0), c.byref(error)))
        if not self.handle:
            raise RuntimeError(error.message.decode())
        self.n, self.m, self.joints, self.channels = (lib.ls_scene_count(self.handle, k) for k in range(4))
        self.states = lib.ls_scene_count(self.handle, STATE)
        self.description = Description()
        lib.ls_scene_describe(self.handle, c.byref(self.description))

    def state_at(self, t):
        """q, v and z that a run reaches; its internal states become those of the scene."""
        tolerances = Tolerances(1e-8, 1e-9, 1e-6, 0.0, 0.05, 5, 0, 10**7)
        run = c.c_void_p(lib.ls_run_new(self.handle, c.byref(tolerances), c.byref(error)))
        if not run:
            raise RuntimeError(error.message.decode())
        values, q, v, z = np.zeros(self.channels), np.zeros(self.n), np.zeros(self.n), np.zeros(self.joints)
        call(lib.ls_run_advance, run, c.c_double(t), pointer(values))
        call(lib.ls_run_state, run, pointer(q), pointer(v), None, None, pointer(z))
        states = np.zeros(self.states)
        call(lib.ls_run_states, run, pointer(states))
        lib.ls_run_free(run)
        self.set_states(states)
        return q, v, z

    def set_states(self, states):
        call(lib.ls_scene_set_states, self.handle, pointer(np.array(states, float)))

    def present_states(self):
        states = np.zeros(self.states)
        call(lib.ls_scene_states, self.handle, pointer(states))
        return states

    def state_rates(self, t, q, v, z):
        """The rates of the internal states, and their derivatives by q, v and the states."""
        result = [np.zeros(self.states), *(np.zeros((self.states, k)) for k in (self.n, self.n, self.states))]
        call(lib.ls_scene_state_rates, self.handle, c.c_double(t), pointer(q), pointer(v), pointer(z), *map(pointer, result))
        return result

    def force_by_states(self, t, q, v, z):
        result = np.zeros((self.n, self.states))
        call(lib.ls_scene_force_by_states, self.handle, c.c_double(t), pointer(q), pointer(v), pointer(z), pointer(result))
        return result

    def force(self, t, q, v, z):
        f, k, d = np.zeros(self.n), np.zeros((self.n, self.n)), np.zeros((self.n, self.n))
        call(lib.ls_scene_force, self.handle, c.c_double(t), pointer(q), pointer(v), pointer(z), pointer(f), pointer(k), pointer(d))
        return f, k, d

    def rows(self, t, q):
        phi, phi_q, phi_t = np.zeros(self.m), np.zeros((self.m, self.n)), np.zeros(self.m)
        call(lib.ls_scene_constraint_rows, self.handle, c.c_double(t), pointer(q), pointer(phi), pointer(phi_q), pointer(phi_t))
        return phi, phi_q, phi_t

    def acceleration(self, t, q, v, z):
        a, multipliers = np.zeros(self.n), np.zeros(self.m)
        call(lib.ls_scene_acceleration, self.handle, c.c_double(t), pointer(q), pointer(v), pointer(z), pointer(a), pointer(multipliers))
        return a

    def names(self, of):
        return [lib.ls_scene_name(self.handle, of, c.c_size_t(i)).decode() for i in range(lib.ls_scene_count(self.handle, of))]
