#!/usr/bin/env python3
"""regroup.py PLAN [FIXUPS]: run in the root of a clean worktree. Moves and merges C++ files of native/src, rewrites all
includes, and replaces old paths in documents, scripts, comments and planted faults. It commits nothing.

PLAN, a block per target:
    folder/name: old/a old/b.h +old/c
      // Head comment of the merged header, or of the source where there is no header.
old/a stands for old/a.h and old/a.cpp, whichever exist; old/b.h and old/b.cpp for one of them. +old/c: c.h is private, it
goes into name.cpp in an anonymous namespace, with c.cpp. -old/d: the comment at the top of d.h is left out. Comments at the
top of the parts stay above them, unless the head comment repeats them. A file that the plan names and that
does not exist is reported and left out. Kernels (Highway) are moved, never merged.

FIXUPS: a Python file with a list FIXUPS of (path, old text, new text, how often it occurs or once), applied afterwards.
"""
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path.cwd()
SRC = ROOT / "native/src"
MACROS_ALLOWED = {"denoise/open_image_denoise.h"}


def die(words):
    raise SystemExit(words)


def is_kernel(path):
    text = path.read_text()
    if str(path.relative_to(SRC)) in MACROS_ALLOWED:
        return False
    return "foreach_target" in text or re.search(r"^#(define|undef|if)\b", text, re.M) is not None


def parts(path):
    """(lead comment, includes, body)."""
    lines = path.read_text().split("\n")
    i, lead = 0, []
    while i < len(lines) and (lines[i].startswith("//") or not lines[i].strip()):
        lead.append(lines[i])
        i += 1
    includes, comment = [], []
    last = i
    while i < len(lines):
        line = lines[i]
        if line.startswith("#include"):
            if comment:
                die(f"{path}: a comment among the includes: {comment}")
            includes.append(line)
            last = i + 1
        elif line.startswith("#pragma once"):
            last = i + 1
        elif line.startswith("//"):
            comment.append(line)
        elif line.strip():
            break
        i += 1
    return "\n".join(lead).strip("\n"), includes, "\n".join(lines[last:]).strip("\n")


def inner(body, path):
    """(namespace or None, using lines, text inside)."""
    m = re.match(r"namespace (velour(?:::capi)?) \{\n(.*)\n\}  // namespace \1$", body, re.S)
    if m and not re.search(r"^\}  // namespace velour", m.group(2), re.M):
        return m.group(1), "", m.group(2).strip("\n")
    m = re.match(r"((?:using namespace [\w:]+;\n)+)(.*)$", body, re.S)
    if m:
        return None, m.group(1).strip("\n"), m.group(2).strip("\n")
    die(f"{path}: not one namespace")


def chunks(text):
    """Top-level pieces, separated by blank lines outside braces."""
    out, now, depth = [], [], 0
    for line in text.split("\n"):
        if not line.strip() and depth == 0:
            if now:
                out.append("\n".join(now))
            now = []
            continue
        now.append(line)
        code = re.sub(r'"(\\.|[^"\\])*"|\'(\\.|[^\'\\])\'|//.*', "", line)
        depth += code.count("{") - code.count("}")
    if now:
        out.append("\n".join(now))
    return out


def unwrapped(text):
    """Without anonymous namespaces around pieces."""
    return re.sub(r"^(namespace \{|\}  // namespace)$\n?", "", text, flags=re.M).strip("\n")


def signature(code):
    code = re.sub(r"\s+", " ", code)
    code = re.sub(r"^(inline|static) ", "", code)
    return re.sub(r"\( ", "(", code).strip()


def private_part(header, source):
    """Declarations and definitions of a private header and its source; comments of declared functions move to their
    definitions."""
    body = unwrapped(source) if source else ""
    kept = []
    definitions = chunks(body)
    for chunk in chunks(header):
        lines = chunk.split("\n")
        comment = []
        while lines and lines[0].startswith("//"):
            comment.append(lines.pop(0))
        code = "\n".join(lines)
        # several declarations in one piece: split at each semicolon that ends a line
        pieces, now = [], comment[:]
        simple = lines and not re.search(r"[{}]|^(struct|class|enum|using|template|inline|constexpr|namespace)\b", code, re.M)
        if not simple:
            kept.append(chunk)
            continue
        for line in lines:
            now.append(line)
            if line.rstrip().endswith(";"):
                pieces.append(now)
                now = []
        if now:
            pieces.append(now)
        left = []
        for piece in pieces:
            words = [l for l in piece if not l.startswith("//")]
            notes = [l for l in piece if l.startswith("//")]
            declared = "\n".join(words).rstrip(";")
            bare = signature(re.sub(r" = (?:\{\}|[^,()]*(?:\([^()]*\))?)(?=[,)])", "", declared))
            for number, definition in enumerate(definitions):
                m = re.match(r"((?://[^\n]*\n)*)(.*?\)(?: const)?)(?= (?:\{|:))", definition, re.S)
                if m and signature(m.group(2)) == bare:
                    head = "\n".join(notes) + "\n" if notes else ""
                    definitions[number] = head + m.group(1) + declared + definition[m.end():]
                    break
            else:
                left += piece
        if left:
            kept.append("\n".join(left))
    return "\n\n".join([*kept, *definitions])


def plain(comment):
    return re.sub(r"\s+", " ", comment.replace("//", " ")).strip().rstrip(".")


def joined(files, head, without):
    """(lead of the first, includes, namespace, using lines, bodies)."""
    lead, includes, bodies, space, using = None, [], [], False, []
    for path in files:
        l, i, b = parts(path)
        if path in without or (head and l and plain(l) in plain(head)):
            l = ""
        n, u, text = inner(b, path)
        if space is False:
            space = n
        elif space != n:
            die(f"{path}: namespace {n}, not {space}")
        using += [x for x in u.split("\n") if x and x not in using]
        if lead is None:
            lead = l
            if head and l:
                text = l + "\n\n" + text
        elif l:
            text = l + "\n\n" + text
        includes += i
        bodies.append(text)
    return lead, includes, space, using, bodies


def include_block(includes, own, header):
    names = list(dict.fromkeys(x for x in includes if own is None or x != f'#include "{own}"'))
    system = sorted((x for x in names if "<" in x), key=str.lower)
    project = sorted((x for x in names if "<" not in x), key=str.lower)
    return "\n".join(system) + ("\n\n" if system and project and not header else "\n" if system and project else "") + "\n".join(project)


def read_plan(path):
    plan, target = {}, None
    for line in Path(path).read_text().splitlines():
        if line.startswith("  //"):
            plan[target][1].append(line.strip())
        elif line.strip() and not line.startswith("#"):
            target, olds = line.split(":")
            target = target.strip()
            if target in plan:
                die(f"twice: {target}")
            plan[target] = (olds.split(), [])
    return plan


def run(*words):
    subprocess.run(words, check=True, cwd=ROOT)


def main():
    plan = read_plan(sys.argv[1])
    new = {}  # old path within src -> new path
    private_headers = set()
    moves, writes, removes = [], {}, []
    for target, (olds, head) in plan.items():
        headers, sources, private, without = [], [], [], set()
        for name in olds:
            is_private, unled, name = name.startswith("+"), name.startswith("-"), name.lstrip("+-")
            ends = ("",) if re.search(r"\.(h|cpp|inc)$", name) else (".h", ".cpp", "-inl.h")
            found = [SRC / (name + end) for end in ends if (SRC / (name + end)).exists()]
            if not found:
                print(f"not there, left out: {name}")
            for path in found:
                if path.name.endswith("-inl.h") or path.suffix == ".inc":
                    moves.append((path, SRC / Path(target).parent / path.name))
                elif path.suffix == ".h":
                    (private if is_private else headers).append(path)
                    if unled:
                        without.add(path)
                else:
                    sources.append((path, is_private))
        own = target + ".h"
        for path in headers:
            new[str(path.relative_to(SRC))] = own
        for path in private:
            new[str(path.relative_to(SRC))] = target + ".cpp"
            private_headers.add(str(path.relative_to(SRC)))
        for path, _ in sources:
            new[str(path.relative_to(SRC))] = target + ".cpp"
        if len(headers) == 1 and not head:
            moves.append((headers[0], SRC / own))
        elif headers:
            for path in headers:
                if is_kernel(path):
                    die(f"has macros: {path}")
            lead, includes, space, _, bodies = joined(headers, "\n".join(head), without)
            top = "\n".join(head) or lead
            writes[SRC / own] = (f"{top}\n#pragma once\n\n{include_block(includes, own, True)}\n\nnamespace {space} {{\n\n"
                                 + "\n\n".join(bodies) + f"\n\n}}  // namespace {space}\n")
            removes += headers
        if len(sources) == 1 and not private:
            moves.append((sources[0][0], SRC / (target + ".cpp")))
        elif sources:
            for path, _ in sources:
                if is_kernel(path):
                    die(f"has macros: {path}")
            text, includes, taken = [], [], []
            lead = None
            hidden = []
            for path in private:
                pl, pi, pb = parts(path)
                source = path.with_suffix(".cpp")
                sb, sl = "", ""
                if any(s == source for s, _ in sources):
                    sl, si, b = parts(source)
                    includes += si
                    sb = inner(b, source)[2]
                    taken.append(source)
                includes += pi
                leads = [l for l in (pl, sl) if l]
                hidden.append("\n\n".join([*leads, private_part(inner(pb, path)[2], sb)]))
            public = [s for s, is_private in sources if s not in taken]
            lead, i, space, using, bodies = joined(public, "", set())
            includes += i
            if hidden:
                hidden_text = "\n\n".join(hidden)
                if bodies[0].startswith("namespace {\n"):
                    bodies[0] = "namespace {\n\n" + hidden_text + "\n\n" + bodies[0][len("namespace {\n"):].lstrip("\n")
                else:
                    bodies[0] = "namespace {\n\n" + hidden_text + "\n\n}  // namespace\n\n" + bodies[0]
            has_own = bool(headers)
            top = lead or ""
            if head and not headers:
                top = "\n".join(head) + ("\n" + lead if lead and len(lead.split("\n")) > 2 else "")
            drop = {f'#include "{h.relative_to(SRC)}"' for h in private}
            includes = [x for x in includes if x not in drop]
            olds_own = {f'#include "{h.relative_to(SRC)}"' for h in headers}
            includes = [x for x in includes if x not in olds_own]
            block = include_block(includes, own, False)
            body, aliases = [], set()
            for line in "\n\n".join(bodies).split("\n"):
                if re.match(r"using \w+ = .*;$", line):
                    if line in aliases:
                        continue
                    aliases.add(line)
                body.append(line)
            body = "\n".join(body)
            if space:
                body = f"namespace {space} {{\n\n{body}\n\n}}  // namespace {space}"
            else:
                body = "\n".join(using) + "\n\n" + body
            text = (top + "\n" if top else "") + (f'#include "{own}"\n\n' if has_own else "") + block + "\n\n" + body + "\n"
            writes[SRC / (target + ".cpp")] = text
            removes += [s for s, _ in sources]
        removes += [p for p in private if p not in removes]
    for a, b in moves:
        new[str(a.relative_to(SRC))] = str(b.relative_to(SRC))
    moves = [(a, b) for a, b in moves if a != b]
    taken_by = set(b for _, b in moves)
    for b in list(writes) + list(taken_by):
        if b.exists() and b not in removes and b not in [a for a, _ in moves]:
            die(f"in the way: {b}")
    for path in removes:
        run("git", "rm", "-q", "--cached", str(path))
        path.unlink()
    for a, b in moves:
        b.parent.mkdir(parents=True, exist_ok=True)
        run("git", "mv", str(a), str(b))
    for path, text in writes.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        run("git", "add", str(path))
    changed = {a: b for a, b in new.items() if a != b}
    touched = rewrite_includes(changed, private_headers)
    touched |= replace_paths(changed)
    touched |= {str(p.relative_to(ROOT)) for p in writes} | {str(b.relative_to(ROOT)) for _, b in moves}
    if len(sys.argv) > 2:
        touched |= apply_fixups(sys.argv[2])
    cpp = sorted(n for n in touched if n.endswith((".h", ".cpp")) and n.startswith("native/"))
    if cpp:
        run("clang-format", "-i", *cpp)
    print(len(moves), "moved,", len(writes), "merged files from", len(removes), ",", len(touched), "touched")
    check_includes()


def tracked():
    text = subprocess.run(["git", "ls-files"], capture_output=True, text=True, check=True, cwd=ROOT).stdout
    return [ROOT / n for n in text.split("\n") if n and (ROOT / n).is_file()]


def rewrite_includes(changed, private_headers):
    touched = set()
    for path in tracked():
        if path.suffix not in (".h", ".cpp") or ROOT / "native" not in path.parents:
            continue
        text = path.read_text()
        name = str(path.relative_to(SRC)) if SRC in path.parents else None
        out, seen = [], set()
        for line in text.split("\n"):
            m = re.match(r'#include "([^"]+)"(.*)', line)
            if m:
                to = changed.get(m.group(1), m.group(1))
                if m.group(1) in private_headers and name != to:
                    die(f"{path} includes {m.group(1)}, which the plan makes private to {to}")
                if to == name or to in seen or m.group(1) in private_headers:
                    continue
                seen.add(to)
                line = f'#include "{to}"{m.group(2)}'
            m = re.match(r'#define HWY_TARGET_INCLUDE "', line)
            if m and name:
                line = f'#define HWY_TARGET_INCLUDE "{name}"'
            out.append(line)
        if "\n".join(out) != text:
            path.write_text("\n".join(out))
            touched.add(str(path.relative_to(ROOT)))
    return touched


def replace_paths(changed):
    """Full paths in all texts, and bare names in comments of native where the name itself changes."""
    touched = set()
    full = re.compile(r"(?<![\w/.-])((?:native/src/|[ab]/native/src/|\.\./src/|src/)?)((?:[a-z_]\w*/)+[\w-]+\.(?:h|cpp|inc))\b")
    stems = {}
    for a, b in changed.items():
        stems.setdefault(Path(a).name, set()).add(Path(b).name)
    existing = {p.name for p in tracked() if SRC in p.parents}
    for path in tracked():
        if path.suffix not in (".h", ".cpp", ".md", ".py", ".patch", ".cmake", ".txt", ".glsl", ".toml", ".in", ".inc", ".csv", ".json", "") and path.suffix:
            continue
        if path.stat().st_size > 3_000_000:
            continue
        try:
            text = path.read_text()
        except UnicodeDecodeError:
            continue
        if "/results/" in str(path) and path.suffix in (".csv", ".json"):
            continue

        def to(m):
            return m.group(1) + changed.get(m.group(2), m.group(2))

        result = full.sub(to, text)
        if ROOT / "native" in path.parents and path.suffix in (".h", ".cpp"):
            lines = []
            for line in result.split("\n"):
                comment = line.find("//")
                if comment >= 0 and not line.startswith("#include"):
                    for m in re.finditer(r"(?<![\w/<.-])[a-z_]\w*\.(?:h|cpp)\b", line[comment:]):
                        options = stems.get(m.group(0))
                        if options and options != {m.group(0)} and m.group(0) not in existing:
                            print(f"bare name: {path.relative_to(ROOT)}: {line.strip()}  -> {options}")
                lines.append(line)
        if result != text:
            path.write_text(result)
            touched.add(str(path.relative_to(ROOT)))
    return touched


def apply_fixups(name):
    space = {}
    exec(Path(name).read_text(), space)
    touched = set()
    for path, old, text, *count in space["FIXUPS"]:
        file = ROOT / path
        have = file.read_text() if file.exists() else ""
        if have.count(old) != (count or [1])[0]:
            print(f"fixup does not apply ({have.count(old)} times): {path}: {old[:70]!r}")
            continue
        file.write_text(have.replace(old, text))
        touched.add(path)
    return touched


def check_includes():
    """Every include of the project exists, and headers form no cycle."""
    graph = {}
    for path in tracked():
        if path.suffix in (".h", ".cpp") and ROOT / "native" in path.parents:
            for name in re.findall(r'^#include "([^"]+)"', path.read_text(), re.M):
                if (SRC / name).exists():
                    if SRC in path.parents:
                        graph.setdefault(str(path.relative_to(SRC)), []).append(name)
                elif not any((ROOT / d / name).exists() for d in ("native/tests", "native/include", "native", "native/fuzz")) and not (path.parent / name).exists() and "velour/version.h" != name and name != "plot/font_bytes.h" and not name.startswith("hwy/") and not name.endswith(".inc"):
                    print(f"no such file: {path.relative_to(ROOT)} includes {name}")
    state = {}

    def visit(name, way):
        if state.get(name) == 2:
            return
        if name in way:
            print("cycle:", " -> ".join(way[way.index(name):] + [name]))
            return
        for other in graph.get(name, []):
            visit(other, way + [name])
        state[name] = 2

    for name in sorted(graph):
        visit(name, [])


main()
