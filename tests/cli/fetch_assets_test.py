"""fetch-assets against a server of its own: TLS alone, a checksum for every file, no wait without a limit."""

import contextlib
import http.server
import io
import os
import pathlib
import shutil
import ssl
import subprocess
import sys
import tarfile
import tempfile
import threading

SOURCE = pathlib.Path(sys.argv[1])
if not all(shutil.which(tool) for tool in ("curl", "openssl")):
    print("skipped: needs curl and openssl")
    sys.exit(77)


def fetch(*arguments, **environment):
    result = subprocess.run([SOURCE / "scripts/fetch-assets", *map(str, arguments)], text=True,
                            env={**os.environ, **environment}, timeout=60,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    return result.returncode, result.stdout, result.stderr


def archive(member, content):
    data = io.BytesIO()
    with tarfile.open(fileobj=data, mode="w:gz") as tar:
        info = tarfile.TarInfo(member)
        info.size = len(content)
        tar.addfile(info, io.BytesIO(content))
    return data.getvalue()


class Handler(http.server.BaseHTTPRequestHandler):
    files = {"/bunny.tar.gz": archive("bunny/reconstruction/bun_zipper.ply", b"no bunny")}

    def do_GET(self):
        if self.path.startswith("/away/"):  # leads to a plain server
            self.send_response(302)
            self.send_header("Location", "http://localhost:1/bunny.tar.gz")
            self.end_headers()
            return
        content = self.files.get(self.path, b"")
        self.send_response(200 if content else 404)
        # Else the connection's end is the content's, which curl takes for cut off where TLS is not closed, too.
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *_):
        pass


@contextlib.contextmanager
def server(context):
    httpd = http.server.ThreadingHTTPServer(("localhost", 0), Handler)
    if context:
        httpd.socket = context.wrap_socket(httpd.socket, server_side=True)
    threading.Thread(target=httpd.serve_forever, daemon=True).start()
    yield httpd.server_address[1]
    httpd.shutdown()


with tempfile.TemporaryDirectory() as folder:
    work = pathlib.Path(folder)
    subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2",
                    "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost",
                    "-keyout", work / "key.pem", "-out", work / "cert.pem"],
                   check=True, stderr=subprocess.DEVNULL)
    tls = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    tls.load_cert_chain(work / "cert.pem", work / "key.pem")
    trusted = {"CURL_CA_BUNDLE": str(work / "cert.pem")}
    to = work / "to"
    bunny = "bunny/bun_zipper.ply"

    with server(tls) as port:
        site = f"https://localhost:{port}"
        ask = ("--to", to, "--site", site)
        code, out, err = fetch(*ask, bunny, **trusted)
        assert code == 1 and "should be b1acc63b" in err and "not taken" in err, (code, out, err)
        assert not (to / bunny).exists()
        code, out, err = fetch(*ask, "dragon/dragon_vrip_res3.ply", **trusted)
        assert code == 1 and "not to be had from" in err and "404" in err, (code, out, err)
        code, out, err = fetch(*ask, bunny)
        assert code == 1 and "certificate" in err, "a server that nobody vouches for"
        code, out, err = fetch("--to", to, "--site", site + "/away", bunny, **trusted)
        assert code == 1 and "not to be had" in err and not (to / bunny).exists(), (code, out, err)
    with server(None) as port:
        code, out, err = fetch("--to", to, "--site", f"http://localhost:{port}", bunny)
        assert code == 1 and "not to be had" in err, (code, out, err)

    mirror = work / "mirror"
    (mirror / "lucy").mkdir(parents=True)
    (mirror / "lucy/lucy_100k.ply").write_bytes(b"no Lucy")
    code, out, err = fetch("--to", to, "--from", mirror, "lucy/lucy_100k.ply")
    assert code == 1 and "should be c57a9517" in err, (code, out, err)
    code, out, err = fetch("--to", to, "lucy/lucy_100k.ply")
    assert code == 1 and "has no address; see --from" in err, (code, out, err)
    for option in ("--sight", "--accept-unknown"):
        assert fetch(option)[0] == 2
    # What has no SHA-256 is not taken from anywhere, and the help says which files these are.
    by_hand = ("buddha/happy_vrip.ply", "blade/blade.ply", "hand/hand.ply")
    shown = fetch("--help")[1]
    assert all(name in shown for name in by_hand) and "set -" not in shown, shown
    named = {line.split("file: ")[1].split(",")[0].split("}")[0].split("#")[0].strip()
             for file in (SOURCE / "configs/scenes").rglob("*.yaml")
             for line in file.read_text().splitlines() if line.strip().startswith(("- {file: ", "- file: "))}
    homeless = {name: value for name, value in os.environ.items() if name not in ("HOME", "XDG_CACHE_HOME", "GFXREPRO_ASSETS")}
    assert subprocess.run([SOURCE / "scripts/fetch-assets", "--list"], env=homeless, capture_output=True).returncode == 0
    assert named - set(fetch("--list")[1].split()) == set(by_hand), named
    (mirror / "hand").mkdir()
    (mirror / "hand/hand.ply").write_bytes(b"a hand")
    code, out, err = fetch("--to", to, "--from", mirror)
    assert not (to / "hand").exists(), (code, out, err)
    for name in ("dragon", *by_hand, ""):
        code, out, err = fetch("--to", to, bunny, name)
        assert code == 2 and err == f"fetch-assets: unknown name '{name}'; see --list\n", (code, out, err)

assets = os.environ.get("GFXREPRO_ASSETS")
if assets:
    with tempfile.TemporaryDirectory() as folder:
        code, out, err = fetch("--to", folder, "--from", assets, "bunny/bun_zipper.ply",
                               "dragon/dragon_vrip.ply", "dragon/dragon_vrip_res3.ply")
        assert code == 0 and out.count("fetched") == 3, (code, out, err)
