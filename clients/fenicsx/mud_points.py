# SPDX-License-Identifier: MIT
"""Points of one MUD material over NumPy arrays: the batch call of mud.h."""
import ctypes
import os

import numpy as np

CONSISTENT = 3
REAL = np.ctypeslib.ndpointer(float, flags="C_CONTIGUOUS")
INTEGER = np.ctypeslib.ndpointer(np.int32, flags="C_CONTIGUOUS")
REPORT = np.dtype([("counts", np.int32, 16), ("value", float), ("lower", float), ("upper", float), ("reached", float),
                   ("pnewdt", float)], align=True)  # mud_report
MUD_PROPS, MUD_STATEV = 1, 2


class Refused(Exception):
    """Some point has no answer to its increment; nothing was written there."""

    def __init__(self, count, pnewdt, sentence):
        super().__init__(sentence)
        self.count, self.pnewdt, self.sentence = count, pnewdt, sentence


class Material:
    """PROPS of the defaults, but for the parameters given by name; checked and prepared once."""

    def __init__(self, library=None, threads=1, **parameters):
        self.library = lib = ctypes.CDLL(library or os.environ.get("MUD_LIBRARY", "libmud.so"))
        lib.mud_default_props.argtypes = [REAL, ctypes.c_int]
        lib.mud_index.argtypes = [ctypes.c_int, ctypes.c_char_p]
        lib.mud_prepare.argtypes = [REAL, ctypes.c_int, REAL, ctypes.c_int, ctypes.c_char_p, ctypes.c_int]
        lib.mud_update_batch_prepared.argtypes = [REAL, ctypes.c_int, REAL, REAL, ctypes.c_int, REAL, ctypes.c_void_p,
                                                  ctypes.c_void_p, ctypes.c_int, ctypes.c_int, REAL, REAL, REAL,
                                                  ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, INTEGER,
                                                  ctypes.c_void_p]
        lib.mud_tangent_list.argtypes = [REAL, ctypes.c_int, ctypes.c_void_p, REAL, REAL, ctypes.c_int, ctypes.c_void_p,
                                         ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int, REAL, ctypes.c_void_p,
                                         ctypes.c_void_p, ctypes.c_void_p, INTEGER, ctypes.c_void_p]
        self.threads = threads
        self.n_state = lib.mud_count(MUD_STATEV)
        self.props = np.zeros(lib.mud_count(MUD_PROPS))
        lib.mud_default_props(self.props, len(self.props))
        for name, value in parameters.items():
            index = lib.mud_index(MUD_PROPS, name.encode())
            if index < 0:
                raise ValueError(f"MUD has no parameter {name}")
            self.props[index] = value
        self.prepared = np.zeros(lib.mud_prepared_size())
        self.set_props(self.props)

    def set_props(self, props):
        """Takes other PROPS, checked, for the updates to come."""
        lib, self.props = self.library, np.array(props, float)
        text = ctypes.create_string_buffer(400)
        if lib.mud_prepare(self.props, len(self.props), self.prepared, len(self.prepared), text, len(text)) != 0:
            raise ValueError(text.value.decode())

    def place(self, name):
        """Place of a name in STATEV."""
        return self.library.mud_index(MUD_STATEV, name.encode())

    def points(self, n, stress, void_ratio, suction=0.0):
        """(stress, state) of n points that begin alike; the first update initialises the rest of the state."""
        state = np.zeros((n, self.n_state))
        state[:, self.place("void_ratio")] = void_ratio
        state[:, self.place("suction")] = suction
        return np.tile(np.asarray(stress, float), (n, 1)), state

    def update(self, stress, state, strain, stress1, state1, tangent, suction=None, dsuction=None):
        """Stress, state and tangent after an increment of strain at every point, or Refused."""
        n = len(stress)
        if n == 0:
            return
        status, reports = np.zeros(n, np.int32), np.zeros(n, REPORT)
        failed = self.library.mud_update_batch_prepared(
            self.prepared, n, stress, state, self.n_state, np.ascontiguousarray(strain),
            *(None if a is None else a.ctypes.data for a in (suction, dsuction)), CONSISTENT, self.threads, stress1,
            state1, tangent, None, None, None, status, reports.ctypes.data)
        if failed:
            first = int(np.flatnonzero(status)[0])
            text = ctypes.create_string_buffer(400)
            self.library.mud_message(reports[first:].ctypes.data_as(ctypes.c_void_p), text, len(text))
            raise Refused(failed, float(reports["pnewdt"].min()), text.value.decode())

    def slopes(self, stress, state, tangent, direction=None, suction=None):
        """Slopes with which the present states go on along a direction of strain (None: as they strained last)."""
        n = len(stress)
        if n == 0:
            return
        status = np.zeros(n, np.int32)
        failed = self.library.mud_tangent_list(
            self.prepared, n, None, stress, state, self.n_state,
            *(None if a is None else a.ctypes.data for a in (direction, suction)), None, self.threads, tangent, None,
            None, None, status, None)
        if failed:
            text = ctypes.create_string_buffer(400)
            self.library.mud_status_text(int(status[np.flatnonzero(status)[0]]), text, len(text))
            raise Refused(failed, 0.5, text.value.decode())
