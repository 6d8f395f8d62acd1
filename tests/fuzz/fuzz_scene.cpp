// fuzz_scene.cpp
