"""The claims of the verification pages, with their own tolerances; the reasons stand in verification/PAGE/README.md."""
import os
import pathlib
import sys

root = pathlib.Path(os.environ.get("MUD_SOURCE_DIR") or pathlib.Path(__file__).parents[2])
sys.dont_write_bytecode = True
sys.path.insert(0, str(root / "verification"))
import pages  # noqa: E402

bench = pages.Bench(pathlib.Path(os.environ.get("MUD_BUILD_DIR") or root / "build/release"))
passed = failed = 0
for page, (claims, _) in pages.PAGES.items():
    for name, value, reference, tolerance, good in claims(bench):
        passed += good
        failed += not good
        if not good:
            print(f"FAILED {page}, {name}: {value}, reference {reference}, allowed {tolerance}")
    if not (root / "verification" / page / "README.md").exists():
        failed += 1
        print(f"FAILED {page}: the page has no README.md")

# A tolerance that nothing can miss proves nothing: a wrong reference is seen.
wrong = pages.claim("planted", 1.0, 1.1, 0.01)
passed += not wrong[4]
failed += wrong[4]
print(f"{passed} passed, {failed} failed")
sys.exit(failed > 0)
