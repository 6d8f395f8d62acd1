// render_test.cpp
