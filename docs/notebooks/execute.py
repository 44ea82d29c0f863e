#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Executes the notebooks of this folder and writes each as a page of the manual: execute.py [--check] [NAME...]

   Without NAME all of them. A notebook (.ipynb, any Jupyter opens it) keeps the outputs of its cells; the page beside
   it (.md, with pictures) shows the same. Cells run in one Python process without Jupyter, in a folder of their own. As
   in Jupyter, the value of the last line of a cell is no output where it ends with a semicolon.
   --check   executes nothing: exit code 1 if a page is not what its notebook holds
"""
import ast
import base64
import contextlib
import io
import json
import os
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def source(cell):
    return "".join(cell["source"])


def lines(text):
    return text.splitlines(keepends=True)


def executed(notebook):
    """The notebook with the outputs that its cells have today."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.rcdefaults()   # whatever a notebook before this one has set
    space, count = {"__name__": "__main__"}, 0
    for cell in notebook["cells"]:
        if cell["cell_type"] != "code":
            continue
        count += 1
        tree = ast.parse(source(cell))
        last = ast.Expression(tree.body.pop().value) if tree.body and isinstance(tree.body[-1], ast.Expr) else None
        printed, outputs = io.StringIO(), []
        with contextlib.redirect_stdout(printed):
            exec(compile(tree, "cell", "exec"), space)
            value = eval(compile(last, "cell", "eval"), space) if last else None
        if printed.getvalue():
            outputs.append({"output_type": "stream", "name": "stdout", "text": lines(printed.getvalue())})
        for number in plt.get_fignums():
            picture = io.BytesIO()
            plt.figure(number).savefig(picture, format="png", dpi=80, metadata={"Software": None})
            data = {"image/png": base64.b64encode(picture.getvalue()).decode()}
            outputs.append({"output_type": "display_data", "data": data, "metadata": {}})
        plt.close("all")
        if value is not None and not hasattr(value, "savefig") and not source(cell).rstrip().endswith(";"):
            outputs.append({"output_type": "execute_result", "execution_count": count, "metadata": {},
                            "data": {"text/plain": lines(repr(value))}})
        cell["outputs"], cell["execution_count"] = outputs, count
    return notebook


def page(notebook, name):
    """(text, pictures by name) of the page of a notebook."""
    parts, pictures = [], {}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "markdown":
            parts.append(source(cell))
            continue
        parts.append(f"```python\n{source(cell)}\n```")
        for output in cell["outputs"]:
            data = output.get("data", {})
            if "image/png" in data:
                picture = f"{name}_{len(pictures) + 1}.png"
                pictures[picture] = base64.b64decode(data["image/png"])
                parts.append(f"![output of the cell above]({picture})")
            else:
                parts.append("```text\n" + "".join(output.get("text") or data["text/plain"]).rstrip("\n") + "\n```")
    text = "\n\n".join(part.strip("\n") for part in parts)
    return f"{text}\n\nThis page is the notebook [{name}.ipynb]({name}.ipynb), executed.\n", pictures


def same(path):
    """Whether page and pictures are those of a notebook."""
    text, pictures = page(json.loads(path.read_text(encoding="utf-8")), path.stem)
    beside = path.with_suffix(".md")
    return (beside.exists() and beside.read_text(encoding="utf-8") == text
            and all((HERE / name).exists() and (HERE / name).read_bytes() == data for name, data in pictures.items()))


def main():
    words = sys.argv[1:]
    if any(word in ("-h", "--help") for word in words):
        print(__doc__)
        return 0
    names = [word for word in words if word != "--check"] or sorted(path.stem for path in HERE.glob("*.ipynb"))
    paths = [HERE / f"{name}.ipynb" for name in names]
    if missing := [str(path) for path in paths if not path.exists()]:
        print("there is no notebook", *missing, file=sys.stderr)
        return 2
    if "--check" in words:
        stale = [path.stem for path in paths if not same(path)]
        if stale:
            print(f"not what the notebook holds: {', '.join(stale)}; run docs/notebooks/execute.py", file=sys.stderr)
        return bool(stale)
    sys.path.insert(0, str(ROOT / "python"))
    os.environ["MUD_TREE"] = str(ROOT)
    for path in paths:
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            notebook = executed(json.loads(path.read_text(encoding="utf-8")))
            os.chdir(ROOT)
        path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        text, pictures = page(notebook, path.stem)
        path.with_suffix(".md").write_text(text, encoding="utf-8")
        for name, data in pictures.items():
            (HERE / name).write_bytes(data)
        print(path.with_suffix(".md").relative_to(ROOT))
    return 0


if __name__ == "__main__":
    sys.exit(main())
