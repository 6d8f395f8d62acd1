// scene_loader.cpp
