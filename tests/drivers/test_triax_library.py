# SPDX-License-Identifier: MIT
"""mud_triax as a library: a case given as text has the table that the program writes, mistakes come back as texts."""
import ctypes
import os
import subprocess
import threading

from checking import build, check, needs_plain_library, root, work
import tables  # noqa: E402 (checking knows its folder)

needs_plain_library()
os.environ["OMP_WAIT_POLICY"] = "passive"  # threads that wait for each other shall not spin
library = ctypes.CDLL(str(build / "drivers/libmud_triax.so"))
handle_of, text_of = ctypes.c_void_p, ctypes.create_string_buffer
for name in ("mud_triax_rows", "mud_triax_columns", "mud_triax_column", "mud_triax_values", "mud_triax_remarks",
             "mud_triax_free"):
    getattr(library, name).argtypes = {
        "mud_triax_column": [handle_of, ctypes.c_int, ctypes.c_int, ctypes.c_char_p, ctypes.c_int],
        "mud_triax_values": [handle_of, ctypes.POINTER(ctypes.c_double)],
        "mud_triax_remarks": [handle_of, ctypes.c_char_p, ctypes.c_int]}.get(name, [handle_of])


def run(text, name=str(root / "drivers/cases/text.nml")):
    """Exit code, message, columns by name, remarks."""
    handle, message = handle_of(), text_of(2000)
    code = library.mud_triax_run(text.encode(), name.encode(), ctypes.byref(handle), message, len(message))
    if not handle:
        return code, message.value.decode(), {}, ""
    rows, count = library.mud_triax_rows(handle), library.mud_triax_columns(handle)
    values = (ctypes.c_double*(rows*count))()
    library.mud_triax_values(handle, values)
    columns, word = {}, text_of(64)
    for i in range(count):
        library.mud_triax_column(handle, i, 1, word, len(word))
        columns[word.value.decode()] = list(values[i*rows:(i + 1)*rows])
    remarks = text_of(library.mud_triax_remarks(handle, None, 0) + 1)
    library.mud_triax_remarks(handle, remarks, len(remarks))
    library.mud_triax_free(handle)
    return code, message.value.decode(), columns, remarks.value.decode()


def by_program(case):
    out = work / f"{case}.csv"
    program, file = build / "drivers/mud_triax", root / f"drivers/cases/{case}.nml"
    subprocess.run([program, file, "--output", out, "--quiet"], check=True)
    rows = tables.rows(out)
    return {name: [row[name] for row in rows] for name in rows[0]}, tables.comments(out)


good = (root / "drivers/cases/undrained_e735_p100.nml").read_text()

# Threads of one process wait for each other: two messages at once would cut each other's words, or end the process.
TURNS = 1500 if os.environ.get("MUD_PRESET", "release") == "release" else 200
answers = []
refused = good.replace("eps_a_end = 0.25", "eps_a_end = 4")


def work_on():
    answers.extend(run(refused)[:2] for _ in range(TURNS))
    answers.append(run(good)[2]["q"])


def test_has_the_table_of_the_program():
    # The file has 16 digits: the number behind each cell is the same when it has them too.
    for case in ("undrained_e735_p100", "constant_water", "lode_simple_shear"):
        wanted, comments = by_program(case)
        code, message, columns, remarks = run((root / f"drivers/cases/{case}.nml").read_text())
        same = code == 0 and list(columns) == list(wanted) and all(
            [f"{x:.15E}" for x in columns[k]] == [f"{float(cell):.15E}" for cell in wanted[k]] for k in wanted)
        check(f"{case} has the table of the program", same and len(
            columns["q"]) > 50, f"{code} {message} {list(columns)}")
        told, written = [[line for line in lines if not line.startswith("case")]
                         for lines in (remarks.splitlines(), comments)]
        check(f"{case}: remarks are those of the file", told == written, remarks)
    code, message, columns, _ = run(good.replace("'undrained'", "'undraind'"))
    told = "undraind" in message and "text.nml:" in message
    check("a refused case has a message and no table", code == 2 and told and not columns, f"{code} {message}")
    code, message, columns, _ = run(good.replace("&stage", "&stage control = 'drained' q_end = 1.0e5 / &stage", 1))
    check("a test that stops keeps its rows", code == 3 and len(columns.get("q", [])) > 1 and "stage 1" in message,
          f"{code} {message}")
    code, message, columns, _ = run(good.replace("/\n", "", 1))
    check("a group that is never closed is told", code == 2 and "line" in message or "inside" in message, message)
    message = text_of(100)
    nothing = handle_of()
    code = library.mud_triax_run(None, None, ctypes.byref(nothing), message, len(message))
    check("no text is no case", code == 2 and not nothing and message.value, message.value)
    check("no table has no rows", library.mud_triax_rows(None) == 0 and library.mud_triax_values(None, None) == -1)
    library.mud_triax_free(None)


def test_threads_have_the_answers_and_the_messages_of_one():
    wanted = {str(run(refused)[:2]), str(run(good)[2]["q"])}
    threads = [threading.Thread(target=work_on) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    apart = {str(answer) for answer in answers} - wanted
    check("threads have the answers and the messages of one", len(
        answers) == 4*(TURNS + 1) and not apart, list(apart)[:3])
