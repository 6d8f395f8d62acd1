// json_fields.cpp
