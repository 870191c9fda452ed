// The same options as shaders/CMakeLists.txt gives the build.
#include "runtime/glsl/compiler.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include "runtime/glsl/shader_sources.h"

namespace loam::glsl {

namespace {

namespace fs = std::filesystem;

class Includer : public glslang::TShader::Includer {
  public:
    Includer(Reader read, std::string shader) : read_(std::move(read)), shader_(std::move(shader)) {}

    IncludeResult* includeLocal(const char* header, const char* from, size_t depth) override {
        if (depth > 32) return nullptr;  // a cycle: glslang itself has no limit
        // The shader's own name is relative to shaders/, those of headers to the root above it.
        const fs::path including = from == shader_ ? fs::path("shaders") / from : fs::path(from);
        const fs::path candidates[] = {(including.parent_path() / header).lexically_normal(),
                                       fs::path(header).lexically_normal()};
        for (const fs::path& name : candidates) {
            auto found = read_(name.generic_string());
            if (!found) continue;
            auto* text = new std::string(std::move(*found));
            return new IncludeResult(name.generic_string(), text->data(), text->size(), text);
        }
        return nullptr;
    }
    void releaseInclude(IncludeResult* result) override {
        if (!result) return;
        delete static_cast<std::string*>(result->userData);
        delete result;
    }

  private:
    Reader read_;
    std::string shader_;
};

Reader with_texts(const Texts& texts, Reader otherwise) {
    return [&texts, otherwise = std::move(otherwise)](const std::string& name) {
        const auto it = texts.find(name);
        return it == texts.end() ? otherwise(name) : std::optional(it->second);
    };
}

// "ERROR: a.comp:3: 'x' : undeclared identifier" loses its first word; the closing counts of errors go.
std::string reduced(const char* log) {
    std::istringstream lines(log);
    std::string line, out;
    while (std::getline(lines, line)) {
        for (const std::string_view word : {"ERROR: ", "WARNING: "})
            if (line.starts_with(word)) line.erase(0, word.size());
        const auto last = line.find_last_not_of(" \t\r");
        line.erase(last == std::string::npos ? 0 : last + 1);
        if (line.empty() || line.find("compilation errors.") != std::string::npos) continue;
        out += out.empty() ? line : "\n" + line;
    }
    return out;
}

}  // namespace

Reader reader_of_files(fs::path root) {
    return [root = std::move(root)](const std::string& name) -> std::optional<std::string> {
        std::ifstream file(root / name, std::ios::binary);
        if (!file) return std::nullopt;
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
}

std::optional<std::string> embedded_text(const std::string& name) {
    constexpr std::string_view kFolder = "shaders/";
    if (!name.starts_with(kFolder)) return std::nullopt;
    const auto sources = shader_sources();
    const auto it =
        std::ranges::find(sources, std::string_view(name).substr(kFolder.size()), &ShaderSource::name);
    return it == sources.end() ? std::nullopt : std::optional(std::string(it->text));
}

Result<Words> compile(std::string_view name, std::string_view source, Reader read, Lines lines) {
    [[maybe_unused]] static const bool started = glslang::InitializeProcess();
    EShLanguage stage;
    if (name.ends_with(".comp"))
        stage = EShLangCompute;
    else if (name.ends_with(".vert"))
        stage = EShLangVertex;
    else if (name.ends_with(".frag"))
        stage = EShLangFragment;
    else
        return error("shader {} is none of .comp, .vert, .frag", name);

    const std::string title(name);
    const char* text = source.data();
    const char* text_name = title.c_str();
    const int length = static_cast<int>(source.size());
    glslang::TShader shader(stage);
    shader.setStringsWithLengthsAndNames(&text, &length, &text_name, 1);
    shader.setEnvInput(glslang::EShSourceGlsl, stage, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
    constexpr auto kMessages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
    Includer includer(std::move(read), title);
    if (!shader.parse(GetDefaultResources(), 460, false, kMessages, includer))
        return error("{}", reduced(shader.getInfoLog()));
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(kMessages)) return error("{}: {}", name, reduced(program.getInfoLog()));
    Words words;
    glslang::SpvOptions options;
    options.disableOptimizer = true;
    options.generateDebugInfo = lines == Lines::yes;
    glslang::GlslangToSpv(*program.getIntermediate(stage), words, &options);
    return words;
}

Result<Words> compile_with(const std::string& base, const Texts& texts, const Reader& files, Lines lines) {
    const auto source = files("shaders/" + base);
    if (!source) return error("there is no source of the shader {}", base);
    return compile(base, *source, with_texts(texts, files), lines);
}

}  // namespace loam::glsl
