#include "runner/config/external_program.h"

#include "tests/support/support.h"

namespace gfxrepro::config {
namespace {

ExternalProgram programOf(const std::string& yaml) {
    return readProgram(parseYaml(yaml, "c.yaml"));
}

std::string errorOf(const std::string& yaml) {
    return errorText([&] { programOf(yaml); });
}

TEST(ExternalProgram, FillsPlaceholders) {
    const Placeholders values = {{"n", "4"}, {"out", "/o"}};
    EXPECT_EQ(filled("-n{n} {out}/x.png", values), "-n4 /o/x.png");
    EXPECT_EQ(filled("{{n}} {{{n}}}", values), "{n} {4}");
    EXPECT_EQ(filled("{unknown} {open", values), "{unknown} {open");
    EXPECT_EQ(filled("a } b", values), "a } b");
    EXPECT_EQ(filled("", values), "");
}

TEST(ExternalProgram, CommandIsALineOrAList) {
    EXPECT_THAT(programOf("command: tracer  -o {out}/x.png").command,
                ElementsAre("tracer", "-o", "{out}/x.png"));
    EXPECT_THAT(programOf("command: [tracer, \"a b\"]").command, ElementsAre("tracer", "a b"));
    EXPECT_EQ(errorOf("params: {}"), "c.yaml:1:1: program needs 'command'");
    EXPECT_EQ(errorOf("command: []"),
              "c.yaml:1:10: program: command is []; allowed: a program and its arguments");
    EXPECT_EQ(errorOf("command: [tracer, {out}]"),
              "c.yaml:1:19: program: command is {out: null}; allowed: text; one that begins with a "
              "brace needs quotes");
}

TEST(ExternalProgram, RefusesWhatStandsForNothing) {
    EXPECT_EQ(errorOf("command: t {widt}"),
              "c.yaml:1:10: program: command: '{widt}' stands for nothing; did you mean 'width'?; "
              "braces as such are {{ and }}");
    EXPECT_EQ(errorOf("command: t\nparams: {n: 1}"),
              "c.yaml:2:10: program: parameter 'n': no argument and no variable has '{n}'");
    EXPECT_EQ(errorOf("command: t {seed}\nparams: {seed: 1}"),
              "c.yaml:2:10: program: parameter 'seed': every program has that placeholder; give it "
              "another name");
    EXPECT_EQ(errorOf("command: t {output}\nparams: {output: a}"),
              "c.yaml:2:10: program: parameter 'output': plans and tables have that of every case; "
              "give it another name");
    EXPECT_EQ(errorOf("command: t\nimages: {result: \"{q}.png\"}"),
              "c.yaml:2:18: program: image 'result': file: '{q}' stands for nothing; allowed: "
              "here, out, scene, width, height, seed, frame, frames; braces as such are {{ and }}");
}

TEST(ExternalProgram, MayGiveAllFramesInOneRun) {
    EXPECT_FALSE(programOf("command: t {frame}").givesAllFrames);
    EXPECT_FALSE(programOf("command: t {frame}\nframes: one").givesAllFrames);
    EXPECT_TRUE(programOf("command: t {frames}\nframes: all").givesAllFrames);
    EXPECT_EQ(errorOf("command: t\nframes: 3"),
              "c.yaml:2:9: program: frames is 3; allowed: one | all");
    EXPECT_EQ(errorOf("command: t {frame}\nframes: all"),
              "c.yaml:1:10: program: {frame}, and one run gives all frames; allowed: {frames}, "
              "their number");
    EXPECT_EQ(errorOf("command: t\nframes: all\nimages: {result: r.png}"),
              "c.yaml:3:18: program: image 'result': file is r.png; allowed: one with {frame}, as "
              "one run leaves the pictures of all frames");
    EXPECT_EQ(errorOf("command: t\nframes: all\nmetrics: {n: {unit: '1', pattern: '(.)'}}"),
              "c.yaml:3:35: program: metric 'n': a pattern does not tell frames apart, and one run "
              "gives them all ('frames: all')");
    const std::string head = "command: t {frames} {n}\nframes: all\nparams: {n: 1}\nimages: ";
    EXPECT_EQ(
        errorOf(head + "{r: {file: \"{frame}.png\", truth: {n: 2, frame: 9}}}"),
        "c.yaml:4:49: program: image 'r': truth: unknown key 'frame'; did you mean 'frames'?");
    EXPECT_EQ(programOf(head + "{r: {file: \"{frame}.png\", truth: {n: 2, frames: 8}}}")
                  .pictures.front()
                  .truthFrames,
              8);
}

TEST(ExternalProgram, ThatTakesASeedHasItAsAParameter) {
    const ExternalProgram program = programOf("command: t {seed}");
    Params params(parseYaml("{seed: 7}", "p"), "technique 't'");
    program.declare(params);
    params.finish();
    EXPECT_EQ(program.valuesOf(params.resolved()).at("seed"), "7");
    Params none(parseYaml("{seed: 7}", "p"), "technique 't'");
    programOf("command: t").declare(none);
    EXPECT_EQ(errorText([&] { none.finish(); }),
              "p:1:2: technique 't': unknown parameter 'seed'; it has none");
    // A truth of another seed or number has random numbers of its own; one of another word need
    // not.
    const std::string image = "command: t {seed} {n}\nparams: {n: 1}\nimages: {r: {file: r.png";
    EXPECT_FALSE(programOf(image + "}}").sharesSeeds);
    EXPECT_FALSE(programOf(image + ", truth: {n: 2, seed: 9}}}").sharesSeeds);
    EXPECT_FALSE(programOf(image + ", truth: \"{here}/t.png\"}}").sharesSeeds);
    EXPECT_FALSE(programOf(image + ", truth: {n: 2}}}").sharesSeeds);
    EXPECT_TRUE(
        programOf(
            "command: t {seed} {m}\nparams: {m: [a, b]}\nimages: {r: {file: r.png, truth: {m: b}}}")
            .sharesSeeds);
    EXPECT_EQ(
        errorOf(
            "command: t {n}\nparams: {n: 1}\nimages: {r: {file: r.png, truth: {n: 2, seed: 3}}}"),
        "c.yaml:3:41: program: image 'r': truth: unknown key 'seed'; allowed: frames, frame, n");
}

TEST(ExternalProgram, TypesAreThoseOfTheDefaults) {
    const ExternalProgram program = programOf(
        "command: t {a} {b} {c} {d} {e} {f} {g}\n"
        "params:\n"
        "  a: 4\n"
        "  b: {default: 4.0, min: 0, max: 8, unit: m, doc: a length}\n"
        "  c: true\n"
        "  d: some text\n"
        "  e: {default: x, choices: [x, y]}\n"
        "  f: 0.5\n"
        "  g: [sobol, jittered]\n");
    Params params(parseYaml("{b: 2.5, e: y}", "p"), "technique 't'");
    program.declare(params);
    params.finish();
    EXPECT_EQ(params.resolved().toFlowText(),
              "{a: 4, b: 2.5, c: true, d: some text, e: y, f: 0.5, g: sobol}");
    EXPECT_EQ(params.declared()[0].type, "integer");
    EXPECT_EQ(params.declared()[1].allowed(), "0 … 8");
    EXPECT_EQ(params.declared()[1].unit, "m");
    EXPECT_EQ(params.declared()[4].doc, "x | y");
    EXPECT_EQ(params.declared()[6].doc, "sobol | jittered");
    const Placeholders values = program.valuesOf(params.resolved());
    EXPECT_EQ(filled("{a} {b} {c} {d} {e} {f} {g}", values), "4 2.5 true some text y 0.5 sobol");
}

TEST(ExternalProgram, RefusesValuesThatAParameterDoesNotTake) {
    const ExternalProgram choice =
        programOf("command: t {m}\nparams: {m: {default: x, choices: [x, y], doc: how}}");
    Params wrong(parseYaml("{m: z}", "p"), "technique 't'");
    EXPECT_EQ(errorText([&] { choice.declare(wrong); }), "p:1:5: m is z; allowed: x | y");
    EXPECT_EQ(wrong.declared()[0].doc, "how (x | y)");
    const ExternalProgram program =
        programOf("command: t {n}\nparams: {n: {default: 4, min: 1, max: 64, unit: sample}}");
    Params params(parseYaml("{n: 128}", "p"), "technique 't'");
    EXPECT_EQ(errorText([&] { program.declare(params); }),
              "p:1:5: technique 't': n is 128; allowed: 1 … 64 sample");
    EXPECT_EQ(errorOf("command: t {n}\nparams: {n: {default: 4, min: 8}}"),
              "c.yaml:2:23: program: parameter 'n': default is 4; allowed: one of the values it "
              "may have");
    EXPECT_EQ(errorOf("command: t {n}\nparams: {n: {default: z, choices: [x, y]}}"),
              "c.yaml:2:23: program: parameter 'n': default is z; allowed: one of the values it "
              "may have");
    EXPECT_EQ(errorOf("command: t {n}\nparams: {n: 3000000000}"),
              "c.yaml:2:13: program: parameter 'n': default is 3000000000; allowed: a whole number "
              "of 32 bits, or one with a point, as 5000000000.0");
    EXPECT_EQ(programOf("command: t {n}\nparams: {n: 3000000000.0}").params.at(0).type,
              ProgramParam::Type::Number);
    EXPECT_EQ(errorOf("command: t {n}\nparams: {n: {default: text, min: 1}}"),
              "c.yaml:2:29: program: parameter 'n': min is of numbers alone");
    EXPECT_EQ(errorOf("command: t {n}\nparams: {n: {unit: m}}"),
              "c.yaml:2:13: program: parameter 'n' needs 'default', a number, a boolean or text");
    EXPECT_EQ(errorOf("command: t {N}\nparams: {N: 1}"),
              "c.yaml:2:10: program: parameter 'N'; allowed: small letters, digits and _, a letter "
              "first");
}

TEST(ExternalProgram, DeclaresWhatItSays) {
    const ExternalProgram program = programOf(
        "command: t\n"
        "metrics:\n"
        "  rays: ray\n"
        "  bytes: {unit: byte, better: lower, doc: of it, optional: true}\n"
        "  facets: {unit: facet, pattern: 'Facets: +([0-9]+)'}\n"
        "  trace_ms: {unit: ms, pattern: '([0-9.]+) s$', scale: 1000}\n"
        "passes: {trace: the rays}\n"
        "images:\n"
        "  depth: depth.exr\n"
        "  result: {file: result.exr, truth: \"{here}/truth.exr\"}\n");
    EXPECT_EQ(program.outputs.find("rays")->unit, "ray");
    EXPECT_EQ(program.outputs.find("bytes")->better, Better::Lower);
    EXPECT_THAT(program.optionalMetrics, ElementsAre("bytes"));
    EXPECT_EQ(program.patterns.at(0).metric, "facets");
    EXPECT_EQ(program.patterns.at(0).scale, 1.0);
    EXPECT_EQ(program.patterns.at(1).scale, 1000.0);
    EXPECT_TRUE(program.outputs.hasPass("trace"));
    EXPECT_TRUE(program.outputs.hasPass("result"));
    EXPECT_FALSE(program.outputs.hasPass("depth"));
    EXPECT_EQ(program.pictures.at(1).truthFile, "{here}/truth.exr");
    // A claim would judge a time of another name from one sample, as what never varies.
    EXPECT_EQ(errorOf("command: t\nmetrics: {render_ms: ms, rays_per_second: ray/s}"), "no error");
    EXPECT_EQ(errorOf("command: t\nmetrics: {render: ms}"),
              "c.yaml:2:19: program: metric 'render' has the unit 'ms'; a time has a name that "
              "ends in _ms and the unit ms, by which claims know it, and nothing else has");
    EXPECT_EQ(errorOf("command: t\nmetrics: {render_ms: {unit: s, pattern: '(.+) s'}}"),
              "c.yaml:2:29: program: metric 'render_ms' has the unit 's'; a time has a name that "
              "ends in _ms and the unit ms, by which claims know it, and nothing else has; 'scale' "
              "multiplies the pattern's number");
    EXPECT_EQ(errorOf("command: t\nmetrics: {fps: {unit: 1/s}}"),
              "c.yaml:2:23: program: metric 'fps' has the unit '1/s'; what is per second has a "
              "name that ends in _per_second, by which claims know that it varies");
    for (const char* unit : {"fps", "Hz", "1/ms", "ray/second", "seconds", "milliseconds"}) {
        EXPECT_THAT(errorOf(std::string("command: t\nmetrics: {speed: ") + unit + "}"),
                    HasSubstr(std::string("'speed' has the unit '") + unit + "'; "));
    }
    EXPECT_EQ(errorOf("command: t\nmetrics: {a: {doc: x}}"),
              "c.yaml:2:11: program: metric 'a' needs 'unit'; \"1\" for none");
    EXPECT_EQ(
        errorOf("command: t\nmetrics: {a: {unit: m, pattern: x}}"),
        "c.yaml:2:33: program: metric 'a': pattern is x; allowed: one with the number in ( )");
    EXPECT_EQ(errorOf("command: t\nmetrics: {a: {unit: m, scale: 2}}"),
              "c.yaml:2:24: program: metric 'a': 'scale' is of a pattern's number alone");
    EXPECT_EQ(errorOf("command: t\nmetrics: {a: {unit: m, pattern: '(.)', scale: 0}}"),
              "c.yaml:2:47: program: metric 'a': scale is 0; allowed: above 0");
    EXPECT_EQ(errorOf("command: t\nmetrics: {a: {unit: m, better: more}}"),
              "c.yaml:2:32: program: metric 'a': better is more; allowed: lower | higher");
    EXPECT_EQ(errorOf("command: t\nmetrics: {a: {unit: m, optional: perhaps}}"),
              "c.yaml:2:34: program: metric 'a': optional is perhaps; allowed: true | false");
    EXPECT_EQ(errorOf("command: t {n}\nparams: {n: {default: 1, min: low}}"),
              "c.yaml:2:31: program: parameter 'n': min is low; allowed: a number");
    EXPECT_EQ(errorOf("command: t\ngpu: 2"),
              "c.yaml:2:6: program: gpu is 2; allowed: true | false");
}

TEST(ExternalProgram, ATruthMayBeMadeByOtherParameters) {
    const std::string head = "command: t {n} {frame}\nparams: {n: {default: 4, max: 64}}\n";
    const ExternalProgram program =
        programOf(head + "images: {result: {file: r.exr, truth: {n: 64, frame: 9}}}");
    EXPECT_EQ(program.pictures.at(0).truthParams.toFlowText(), "{n: 64, frame: 9}");
    EXPECT_EQ(errorOf(head + "images: {result: {file: r.exr, truth: {n: 65}}}"),
              "c.yaml:3:43: program: image 'result': truth: n is 65; allowed: at most 64");
    EXPECT_EQ(errorOf(head + "images: {result: {file: r.exr, truth: {m: 6}}}"),
              "c.yaml:3:40: program: image 'result': truth: unknown key 'm'; did you mean 'n'?");
    // It would be the picture itself, and every error 0.
    EXPECT_EQ(errorOf("command: t\nimages: {result: {file: r.exr, truth: {frame: 9}}}"),
              "c.yaml:2:47: program: image 'result': truth: 'frame', and the program's command has "
              "no {frame}");
}

TEST(ExternalProgram, ATruthMayBeOfSeveralSeeds) {
    const std::string head = "command: t {frame}\nimages: {result: {file: r.exr, truth: ";
    const ExternalProgram program = programOf(head + "{frame: 9, frames: 6}}}");
    EXPECT_EQ(program.pictures.at(0).truthFrames, 6);
    EXPECT_EQ(program.pictures.at(0).truthParams.toFlowText(), "{frame: 9}");
    EXPECT_EQ(programOf(head + "{frame: 9}}}").pictures.at(0).truthFrames, 1);
    for (const char* frames : {"1", "1001", "2.5", "many"}) {
        EXPECT_EQ(errorOf(head + "{frame: 9, frames: " + frames + "}}}"),
                  std::string("c.yaml:2:58: program: image 'result': truth: frames is ") + frames +
                      "; allowed: 2 … 1000 pictures, each of another seed");
    }
    const std::string alike =
        "program: image 'result': truth: 'frames' are other seeds from 'frame' on: give that, a "
        "whole number, and {frame} to the program";
    EXPECT_EQ(errorOf(head + "{frames: 6}}}"), "c.yaml:2:48: " + alike);
    EXPECT_EQ(errorOf("command: t\nimages: {result: {file: r.exr, truth: {frame: 9, frames: 6}}}"),
              "c.yaml:2:58: " + alike);
}

TEST(ExternalProgram, ItsKeyIsOfItsFiles) {
    const TemporaryFolder folder;
    const auto script = folder.write("run.sh", "#!/bin/sh\n");
    fs::permissions(script, fs::perms::owner_all);
    folder.write("scene.txt", "one");
    folder.write("more.txt", "two");
    folder.write("truth.png", "three");
    const std::string here = folder.path().string();
    const ExternalProgram program = programOf(
        "command: \"{here}/run.sh +I{here}/{scene_name}.txt\"\n"
        "params: {scene_name: scene}\n"
        "images: {result: {file: r.png, truth: \"{here}/truth.png\"}}\n"
        "files: [more.txt]\nhere: " +
        here);
    const auto filesNow = [&](const std::string& scene) {
        return filesOf(program, {{"here", here}, {"scene_name", scene}});
    };
    std::vector<std::string> names;
    for (const ProgramFile& file : filesNow("scene")) names.push_back(file.name);
    EXPECT_THAT(names, ElementsAre(here + "/run.sh", "scene.txt", "truth.png", "more.txt"));
    FileDigests digests;
    const std::string key = programKey(filesNow("scene"), digests);
    EXPECT_EQ(key.size(), 64U);
    EXPECT_EQ(programKey(filesNow("scene"), digests), key);
    EXPECT_NE(programKey(filesNow("none"), digests), key);
    folder.write("truth.png", "another");
    EXPECT_NE(programKey(filesNow("scene"), digests), key);
    folder.write("truth.png", "three");
    EXPECT_EQ(programKey(filesNow("scene"), digests), key);
    folder.write("scene.txt", "other");
    EXPECT_NE(programKey(filesNow("scene"), digests), key);
}

TEST(ExternalProgram, OneThatIsNotHereHasNoKey) {
    const ExternalProgram absent = programOf("command: no-such-program-anywhere");
    FileDigests digests;
    EXPECT_EQ(programKey(filesOf(absent, {}), digests), "");
    EXPECT_EQ(absentOf(filesOf(absent, {}))->name, "no-such-program-anywhere");
    const ExternalProgram starter = programOf("command: sh\nstarts: [no-such-program-anywhere]");
    EXPECT_EQ(absentOf(filesOf(starter, {}))->name, "no-such-program-anywhere");
    // From the config's folder on, with and without a placeholder.
    for (const char* name : {"\"{here}/sh\"", "./sh"}) {
        const ExternalProgram beside =
            programOf("command: sh\nstarts: [" + std::string(name) + "]\nhere: /bin");
        EXPECT_EQ(filesOf(beside, {{"here", "/bin"}}).at(1).path, "/bin/sh");
    }
    const ExternalProgram other = programOf("command: sh\nfiles: [no-such-file]\nhere: /usr");
    EXPECT_EQ(errorText([&] { filesOf(other, {}); }),
              "program: files: there is no file /usr/no-such-file");
}

TEST(ExternalProgram, NamesFilesThatAreNotThereByTheirPlace) {
    const auto missingIn = [](const std::string& yaml) {
        const Node node = parseYaml(yaml, "c.yaml");
        const ExternalProgram program = readProgram(node);
        return errorText([&] { requireFiles(node, program, {{"here", "/usr"}, {"n", "gone"}}); });
    };
    EXPECT_EQ(missingIn("command: sh\nfiles: [bin/sh, no-such-file]\nhere: /usr"),
              "c.yaml:2:17: program: files: there is no file /usr/no-such-file");
    EXPECT_EQ(missingIn("command: sh\nstarts: [sh, \"{here}/bin/none\"]\nhere: /usr"),
              "c.yaml:2:14: program: starts: there is no program /usr/bin/none");
    EXPECT_EQ(missingIn("command: bin/none\nhere: /usr"),
              "c.yaml:1:10: program: command: there is no program /usr/bin/none");
    // Other machines may have these.
    for (const char* elsewhere : {"none", "/opt/none", "../none", "bin/sh"}) {
        EXPECT_EQ(missingIn("command: sh\nstarts: [" + std::string(elsewhere) + "]\nhere: /usr"),
                  "no error");
    }
    const std::string head =
        "command: sh {n} {frame}\nparams: {n: a}\nimages: {r: {file: r.png, truth: ";
    EXPECT_EQ(missingIn(head + "\"{here}/{n}.png\"}}"),
              "c.yaml:3:34: program: image 'r': truth: there is no file /usr/gone.png");
    for (const char* later : {"\"{here}/{frame}.png\"", "\"{out}/{n}.png\"", "t.png", "{n: b}"}) {
        EXPECT_EQ(missingIn(head + later + "}}"), "no error") << later;
    }
}

TEST(ExternalProgram, RefusesWhatItCouldNotTake) {
    EXPECT_EQ(errorOf("command: t -o {out"),
              "c.yaml:1:10: program: command: a brace of 't -o {out' is not closed; braces as such "
              "are {{ and }}");
    EXPECT_EQ(errorOf("command: t {{out"), "no error");
    EXPECT_EQ(errorOf(R"(command: [t, "a\0b"])"),
              "c.yaml:1:14: program: command has a byte of 0; allowed: text without one");
    EXPECT_EQ(errorOf("command: t\nmetrics: {m: null}"),
              "c.yaml:2:11: program: metric 'm' needs 'unit'; \"1\" for none");
    EXPECT_EQ(errorOf("command: t\nimages: {r: r.gif}"),
              "c.yaml:2:13: program: image 'r': file is r.gif; allowed: a name that ends in one of "
              ".exr, .png, .pfm, .hdr, .pbm, .pgm, .ppm, .pnm, .tga, .tif, .tiff, .jpg, .jpeg");
    EXPECT_EQ(errorOf("command: t {n}\nparams: {n: a.png}\nimages: {r: \"{n}\"}"), "no error");
    EXPECT_EQ(errorOf("command: t\nimages: {r: {file: r.png, truth: t.gif}}"),
              "c.yaml:2:34: program: image 'r': truth is t.gif; allowed: a name that ends in one "
              "of .exr, .png, .pfm, .hdr, .pbm, .pgm, .ppm, .pnm, .tga, .tif, .tiff, .jpg, .jpeg");
    EXPECT_EQ(errorOf("command: t\nimages: {r: {file: r.png, truth: {}}}"),
              "c.yaml:2:34: program: image 'r': truth is {}; allowed: a file, or parameters that "
              "are not the case's");
    for (const std::string name : {"", "A=B"}) {
        EXPECT_EQ(errorOf("command: t\nenv: {\"" + name + "\": x}"),
                  "c.yaml:2:7: program: env: '" + name +
                      "' is no name of a variable; allowed: one without '='");
    }
}

}  // namespace
}  // namespace gfxrepro::config
