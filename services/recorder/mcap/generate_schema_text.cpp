// SPDX-License-Identifier: Apache-2.0
//
// generate_schema_text OUT.cpp FILE.idl …: writes the source of schema_text().

#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

/// The text of an IDL file with its includes resolved, each file once, in the order of need.
std::string resolved(const std::string& path, std::set<std::string>& seen) {
    if (!seen.insert(path).second) return "";
    std::ifstream in(path);
    if (!in) throw std::runtime_error(path + ": cannot be opened");
    const std::string folder = path.substr(0, path.rfind('/') + 1);
    std::string text;
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("#include \"") && line.ends_with('"')) {
            text += resolved(folder + line.substr(10, line.size() - 11), seen);
        } else if (line.find("#include") != std::string::npos) {
            throw std::runtime_error(path + ": an include of a form that is not known: " + line);
        } else {
            text += line + "\n";
        }
    }
    return text;
}

/// The names of the structs and unions that a file itself declares, in their modules.
std::set<std::string> types_of(const std::string& path) {
    std::ifstream in(path);
    std::string scope;
    std::set<std::string> names;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string kind;
        std::string name;
        words >> kind >> name;
        if (kind == "module") scope += name + "::";
        if (kind == "struct" || kind == "union") names.insert(scope + name);
    }
    return names;
}

void generate(const std::string& out_path, const std::vector<std::string>& files) {
    std::ostringstream out;
    out << "// Generated from idl/.\n"
           "#include \"services/recorder/mcap/schema_text.hpp\"\n\n"
           "#include <array>\n#include <utility>\n\n"
           "namespace pursuit::recorder::mcap {\nnamespace {\n\n";
    std::map<std::string, std::size_t> types;
    for (std::size_t i = 0; i < files.size(); ++i) {
        std::set<std::string> seen;
        out << "constexpr std::string_view text_" << i << " = R\"idl(" << resolved(files[i], seen)
            << ")idl\";\n";
        for (const auto& name : types_of(files[i])) types.emplace(name, i);
    }
    out << "constexpr std::array<std::pair<std::string_view, std::string_view>, " << types.size()
        << "> types = {{\n";
    for (const auto& [name, file] : types) {
        out << "    {\"" << name << "\", text_" << file << "},\n";
    }
    out << "}};\n\n}  // namespace\n\n"
           "std::string_view schema_text(std::string_view type_name) {\n"
           "    for (const auto& [name, text] : types) {\n"
           "        if (name == type_name) return text;\n"
           "    }\n"
           "    return {};\n"
           "}\n\n}  // namespace pursuit::recorder::mcap\n";
    std::ofstream file(out_path);
    file << out.str();
    file.close();
    if (!file) throw std::runtime_error(out_path + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 3) throw std::runtime_error("usage: generate_schema_text OUT.cpp FILE.idl …");
        generate(argv[1], std::vector<std::string>(argv + 2, argv + argc));
    } catch (const std::exception& error) {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
