"""What mkdocs does not know of this repository (mkdocs.yml names this file).

Pages come from outside docs/ too: README files of reference runs, the changelog, and the tutorials that tools/docs has executed. Links
are written for those who read the repository; here they lead to pages, or to copies of the files that they name.
"""

import json
import pathlib
import re

from mkdocs.structure.files import File
from pymdownx.slugs import slugify

ROOT = pathlib.Path(__file__).resolve().parents[3]
RUNS = ROOT / "reference_runs"
EXECUTED = ROOT / "build/tutorials"
CODE = r"^(?: {4}|\t)[^\n]*$|^```.*?^```|`[^`\n]*`"
LINK = r"(?P<mark>!?)\[(?P<words>(?:[^\[\]]|\[[^\]]*\])*)\]\((?P<target>[^)\s]+)\)"
CODE_OR_LINK = re.compile(f"{CODE}|{LINK}", re.M | re.S)
pages = {}  # file of the repository: its File of the site


def outside():
    """Files of the site that do not lie in docs/, each with its path in the site."""
    yield RUNS / "README.md", "reference_runs/index.md"
    for readme in sorted(RUNS.glob("*/README.md")):
        yield readme, f"reference_runs/{readme.parent.name}.md"
    for file in sorted(EXECUTED.glob("*")):
        yield file, f"tutorials/{file.name}"
    yield ROOT / "CHANGELOG.md", "CHANGELOG.md"


def place(file):
    """What a file of the site is in the repository, where links are written: the page of a tutorial is its script."""
    path = pathlib.Path(file.abs_src_path)
    if not path.is_relative_to(EXECUTED):
        return path
    return ROOT / "docs/tutorials" / (f"{path.stem}.py" if path.suffix == ".md" else path.name)


def site_file(source, path, config):
    file = File(path, str(ROOT), config["site_dir"], config["use_directory_urls"])
    file.abs_src_path = str(source)
    return file


def on_config(config):
    config["mdx_configs"]["toc"]["slugify"] = slugify(case="lower")  # anchors as where the repository is read
    return config


def on_files(files, config):
    for file in [f for f in files if f.src_path.endswith(".py")]:
        files.remove(file)  # the sources of tutorials
    for source, path in outside():
        files.append(site_file(source, path, config))
    pages.clear()
    pages.update({place(f): f for f in files})
    config["nav"] = expanded(config["nav"])
    for page in files.documentation_pages():  # what links name is copied, so it has to be known before pages are written
        text = pathlib.Path(page.abs_src_path).read_text(encoding="utf-8")
        for match in CODE_OR_LINK.finditer(text):
            other = target_of(place(page), match["target"] or "")
            if other and other.is_file() and other not in pages and other.is_relative_to(ROOT):
                where = f"repository/{other.relative_to(ROOT)}{'' if other.suffix in ('.png', '.svg', '.json', '.txt') else '.txt'}"
                pages[other] = site_file(other, where, config)
                files.append(pages[other])
    return files


def expanded(nav):
    """`folder/*` in the nav: all pages of the folder that the nav does not name, by name."""
    text = json.dumps(nav)

    def step(item):
        if isinstance(item, dict):
            return [{key: step(value) if isinstance(value, list) else value for key, value in item.items()}]
        if isinstance(item, list):
            return [inner for one in item for inner in step(one)]
        if not item.endswith("/*"):
            return [item]
        inside = sorted(f.src_path for f in pages.values() if f.src_path.startswith(item[:-1]) and f.src_path.endswith(".md"))
        return [path for path in inside if f'"{path}"' not in text]

    return [inner for one in nav for inner in step(one)]


def target_of(source, target):
    """The file or folder that a link names; None of links within the page or out of the repository."""
    path = target.split("#")[0]
    return (source.parent / path).resolve() if path and "://" not in path and not path.startswith("mailto:") else None


def rewritten(text, source, here):
    """The links of a page, made to lead to pages and files of the site."""

    def link(match):
        if match["target"] is None:
            return match[0].replace("\\|", "|") if match[0].startswith("`") else match[0]  # code, whose bars split no table here
        mark, words, target = match["mark"], match["words"], match["target"]
        other = target_of(source, target)
        if other is None:
            return match[0]
        if other.is_dir():
            other = next((other / name for name in ("README.md", "index.md") if other / name in pages), other)
        if other in pages:
            to, anchor = pages[other], "#" + target.split("#")[1] if "#" in target else ""
            depth = here.src_path.count("/")
            return f"{mark}[{words}]({'../' * depth}{to.src_path}{anchor})"
        if other.is_dir():
            return words  # a folder of the repository: nothing to open here
        raise SystemExit(f"{source.relative_to(ROOT)}: link to {target}: no such file")

    return CODE_OR_LINK.sub(link, text)


def title_of(readme):
    return readme.read_text(encoding="utf-8").split("\n")[0].lstrip("# ")


def on_page_markdown(markdown, page, config, files):
    page.title = page.title.replace("`", "")
    if page.file.src_path == "reference_runs/index.md":
        runs = [file for file, _ in outside() if file.parent.parent == RUNS]
        markdown += "\n## The runs\n\n" + "".join(f"- [{title_of(run)}]({run.parent.name}/README.md)\n" for run in runs)
    return rewritten(markdown, place(page.file), page.file)


def on_post_page(output, page, config):
    """Search without a server: a browser opens neither workers nor JSON from the disk, so both come as a script."""
    up = "../" * page.file.dest_path.count("/")
    script = f"<script>if(location.protocol===\"file:\")document.write('<script src=\"{up}search/offline.js\"><\\/script>')</script>\n"
    return re.sub(r'(<script src="[^"]*bundle\.)', lambda m: script + m[1], output, count=1)


def on_post_build(config):
    site = pathlib.Path(config["site_dir"])
    (site / "404.html").unlink(missing_ok=True)  # of a server, at its root
    index = (site / "search/search_index.json").read_text(encoding="utf-8")
    worker = next(site.glob("assets/javascripts/workers/search.*.js")).read_text(encoding="utf-8").split("//# sourceMappingURL")[0]
    (site / "search/offline.js").write_text(
        f"var __search={{index:Promise.resolve({index}),worker:URL.createObjectURL(new Blob([{json.dumps(worker)}]))}};\n", encoding="utf-8")
