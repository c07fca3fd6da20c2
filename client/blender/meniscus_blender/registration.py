"""Registers the add-on's parts, in the order in which they need each other."""

import bpy

from . import handlers, live_operators, operators, panel, preferences, properties, services

_CLASSES = (preferences.MeniscusPreferences, *operators.CLASSES, *live_operators.CLASSES, *panel.CLASSES)


def register():
    properties.register()
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    services.start(preferences.cache_folder(), preferences.cache_bytes())
    handlers.register()
    panel.register()


def unregister():
    panel.unregister()
    handlers.unregister()
    services.stop()
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
    properties.unregister()
