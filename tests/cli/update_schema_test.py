"""update_schema --check must be able to fail: on a changed file, and on a config without its line."""

import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCE, BUILD = (pathlib.Path(argument) for argument in sys.argv[1:3])


def check(configs):
    result = subprocess.run([SOURCE / "scripts/update_schema", "--check", "--configs", configs,
                             BUILD], text=True, stdout=subprocess.PIPE)
    return result.returncode, result.stdout.replace(str(configs), "CONFIGS")


with tempfile.TemporaryDirectory() as folder:
    configs = pathlib.Path(folder) / "configs"
    shutil.copytree(SOURCE / "configs", configs)
    assert check(configs) == (0, ""), check(configs)

    readme = configs / "README.md"
    readme.write_text(readme.read_text().replace("| `title` |", "| `headline` |"))
    (configs / "schema/scene.json").unlink()
    smoke = configs / "smoke/template.yaml"
    smoke.write_text(smoke.read_text().split("\n", 1)[1])
    advice = "is not what the schema makes of it; run scripts/update_schema\n"
    line = "# yaml-language-server: $schema=../schema/experiment.json"
    assert check(configs) == (
        1, f"CONFIGS/schema/scene.json: {advice}CONFIGS/README.md: {advice}"
           f"CONFIGS/smoke/template.yaml: the first line must be '{line}'\n"), check(configs)
