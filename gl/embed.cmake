# Writes a C++ file that holds shader texts: kEmbeddedShaders of gl/shader_text.h.
#   cmake -DOUTPUT=shaders.cpp -DFOLDER=/project "-DINPUTS=a.glsl;b.comp" -P embed.cmake
set(code "#include \"gl/shader_text.h\"\n\nnamespace zonal::gl {\n\nconst EmbeddedShader kEmbeddedShaders[] = {\n")
set(count 0)
foreach(input IN LISTS INPUTS)
  file(READ "${FOLDER}/${input}" text)
  string(APPEND code "{\"${input}\", R\"GLSL(${text})GLSL\"},\n")
  math(EXPR count "${count} + 1")
endforeach()
string(APPEND code "};\nconst size_t kEmbeddedShaderCount = ${count};\n\n}  // namespace zonal::gl\n")
file(WRITE "${OUTPUT}" "${code}")
