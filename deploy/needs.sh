# Sourced by check.sh in continuous integration: installs what tests need beside Rust, so that none is skipped there.
#
# A Chromium for the page, and a Python of its own with MuJoCo, onnxruntime, DDS, YAML and TensorBoard, under target/. Ends with
# failure where a registry cannot be reached; the tests that lack something are then counted as skipped.
needs_python=$PWD/target/needs
if ! command -v chromium >/dev/null 2>&1 && ! command -v google-chrome >/dev/null 2>&1; then
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null 2>&1; then
        apt-get update -qq >/dev/null && apt-get install -y -qq chromium >/dev/null
    fi || printf '== needs: no Chromium could be installed\n\n'
fi
# One that was made before may lack what has been added since.
{ [ -x "$needs_python/bin/python" ] || python3 -m venv "$needs_python"; } &&
    "$needs_python/bin/pip" install --quiet --disable-pip-version-check -r deploy/transfer/requirements.txt \
        -r deploy/robot/requirements.txt tensorboard pyyaml || printf '== needs: no Python with the packages of deploy/transfer and deploy/robot could be made\n\n'
if [ -x "$needs_python/bin/python" ]; then
    AMPCO_PYTHON=$needs_python/bin/python
    export AMPCO_PYTHON
fi
{ command -v chromium || command -v google-chrome; } >/dev/null 2>&1 &&
    "${AMPCO_PYTHON:-python3}" -c 'import cyclonedds, mujoco, onnxruntime, tensorboard, yaml' >/dev/null 2>&1
