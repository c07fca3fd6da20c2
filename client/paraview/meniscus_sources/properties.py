"""XML of properties, as ParaView's plugins describe them."""

from __future__ import annotations


def text(name, label, documentation, default="", extra="", hints=""):
    """XML of a property that is a line of text, set by a method Set<name>."""
    return f"""
        <StringVectorProperty name="{name}" label="{label}" command="Set{name}" number_of_elements="1"
                              default_values="{default}" {extra}>
          <Documentation>{documentation}</Documentation>{hints}
        </StringVectorProperty>"""


def path(name, label, documentation):
    return text(name, label, documentation, "", 'panel_visibility="advanced"', '<FileListDomain name="files"/>')


TIMES = """
        <DoubleVectorProperty name="TimestepValues" information_only="1" repeatable="1"
                              si_class="vtkSITimeStepsProperty">
          <TimeStepsInformationHelper/>
        </DoubleVectorProperty>"""

REFRESH = """
        <Property name="Refresh" command="Refresh" panel_widget="command_button">
          <Documentation>Look again at what there is.</Documentation>
        </Property>"""
