// ShaderLibrary::compile: GLSL to SPIR-V with glslang. The same options as shaders/CMakeLists.txt gives the
// build.
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include "runtime/gpu/shader_library.h"

namespace loam::gpu {

namespace {

namespace fs = std::filesystem;

class Includer : public glslang::TShader::Includer {
  public:
    Includer(fs::path root, std::string shader) : root_(std::move(root)), shader_(std::move(shader)) {}

    IncludeResult* includeLocal(const char* header, const char* from, size_t depth) override {
        if (depth > 32) return nullptr;  // a cycle: glslang itself has no limit
        // The shader's own name is relative to shaders/, those of headers to the root above it.
        const fs::path including = from == shader_ ? fs::path("shaders") / from : fs::path(from);
        const fs::path candidates[] = {(including.parent_path() / header).lexically_normal(),
                                       fs::path(header).lexically_normal()};
        for (const fs::path& name : candidates) {
            std::ifstream file(root_ / name, std::ios::binary);
            if (!file) continue;
            auto* text = new std::string(std::istreambuf_iterator<char>(file), {});
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
    fs::path root_;
    std::string shader_;
};

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

Result<std::vector<uint32_t>> ShaderLibrary::compile(std::string_view name, std::string_view source,
                                                     const fs::path& include_root) {
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
    Includer includer(include_root, title);
    if (!shader.parse(GetDefaultResources(), 460, false, kMessages, includer))
        return error("{}", reduced(shader.getInfoLog()));
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(kMessages)) return error("{}: {}", name, reduced(program.getInfoLog()));
    std::vector<uint32_t> words;
    glslang::SpvOptions options;
    options.disableOptimizer = true;
    glslang::GlslangToSpv(*program.getIntermediate(stage), words, &options);
    return words;
}

}  // namespace loam::gpu
