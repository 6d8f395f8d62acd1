// scene_test.cpp
