// scene_loader_test.cpp
